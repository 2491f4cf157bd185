"""Recorded walks with satellite fixes cut in: the fuser on what the tracker made of real sensors.

Recipe: a trial is tracked as it is (``muster track WALKS/TRIAL --out TRACKS/TRIAL.csv``).  Its
measured truth, turned by a drawn angle, gets a fix a second during the first 60 per cent of the
walk and none after, with the receiver errors of ``walks`` and a part that all receivers share.
The tracker's own frame has whatever heading it came to.  Every trial is fused with many draws
of angle and errors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from base_station.fusion.gps_switching import GpsSwitching
from base_station.fusion.interface import CompassHeading, FuserKind
from shared.errors import UserError
from tests.bench.fusion.simulated_walks import RATE_HZ, Errors, Floats, Receiver, Walk, run
from tests.rig.incident.scores import CHI2_95_2DOF

WITH_GPS = 0.6  # of a walk
DRAWS = 24  # what all receivers share hardly changes during a walk: each draw has one
SETTLED_S = 20.0
PEER_HEADING_STD_RAD = math.radians(5.0)
ERRORS = Errors(common_m=1.5)  # orbits, clocks and the air, where nobody takes them off


@dataclass(frozen=True)
class Tracked:
    """A recorded walk at the rate of position messages, from its first to its last truth."""

    name: str
    t_s: Floats
    own_m: Floats  # (n, 2) as tracked
    truth_m: Floats  # (n, 2) as measured, to be compared in any turn


@dataclass
class RecordedScores:
    """Errors in metres while there are fixes and after, by way of knowing."""

    with_m: dict[str, list[float]] = field(default_factory=dict)
    after_m: dict[str, list[float]] = field(default_factory=dict)
    held_with: list[bool] = field(default_factory=list)
    held_after: list[bool] = field(default_factory=list)

    def note(self, way: str, with_m: Floats, after_m: Floats) -> None:
        self.with_m.setdefault(way, []).extend(with_m.tolist())
        self.after_m.setdefault(way, []).extend(after_m.tolist())


def read_tracks(walks: Path, tracks: Path) -> list[Tracked]:
    """Every track that has a trial of its name with truth; UserError where there is none."""
    found = list(_tracked(walks, tracks))
    if not found:
        raise UserError(
            f"no track in {tracks} has a trial with truth in {walks}; write some with "
            f"muster track {walks}/TRIAL --out {tracks}/TRIAL.csv"
        )
    return found


def fuse_recorded(kind: FuserKind, tracked: list[Tracked], draws: int = DRAWS) -> RecordedScores:
    scores = RecordedScores()
    for number, recorded in enumerate(tracked):
        for draw in range(draws):
            rng = np.random.default_rng(100 * number + draw)
            walk = turned(recorded, rng)
            cut = round(WITH_GPS * len(walk))
            begin = round(SETTLED_S * RATE_HZ)
            until_s = float(recorded.t_s[cut])
            receiver = Receiver(rng, ERRORS)
            fused = run(kind.new(), walk, receiver, (-math.inf, until_s))
            errors_m = np.array(fused.error_m)
            scores.note("fused", errors_m[begin:cut], errors_m[cut:])
            held = np.array(fused.normalised2) < CHI2_95_2DOF
            scores.held_with += held[begin:cut].tolist()
            scores.held_after += held[cut:].tolist()
            turn_rad = _best_turn_rad(walk) + rng.normal(0.0, PEER_HEADING_STD_RAD)
            switching = GpsSwitching().new()
            switching.update_heading(CompassHeading(turn_rad, PEER_HEADING_STD_RAD))
            peer = run(switching, walk, _again(recorded, number, draw), (-math.inf, until_s))
            switching_m = np.array(peer.error_m)
            scores.note("switching", switching_m[begin:cut], switching_m[cut:])
            alone_m = _fixes_alone_m(walk, _again(recorded, number, draw), cut)
            scores.note("fixes alone", alone_m[begin:cut], alone_m[cut:])
    return scores


def print_recorded(kind: FuserKind, walks: Path, tracks: Path) -> None:
    """One table of CE50 / CE95 while there are fixes, and after."""
    tracked = read_tracks(walks, tracks)
    scores = fuse_recorded(kind, tracked)
    table = Table(title=f"{len(tracked)} recorded walks, {DRAWS} draws: CE50 / CE95 in metres")
    for heading in ("", "with fixes", "after them"):
        table.add_column(heading, justify="right" if heading else "left")
    for way, with_m in scores.with_m.items():
        cells = [np.percentile(part, [50.0, 95.0]) for part in (with_m, scores.after_m[way])]
        table.add_row(way, *(f"{ce50_m:.1f} / {ce95_m:.1f}" for ce50_m, ce95_m in cells))
    held = (np.mean(scores.held_with), np.mean(scores.held_after))
    table.add_row("region holds the truth", *(f"{part:.1%}" for part in held))
    Console().print(table)


def turned(recorded: Tracked, rng: np.random.Generator) -> Walk:
    """The walk with its truth turned by a drawn angle."""
    angle_rad = rng.uniform(-math.pi, math.pi)
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    steps_m = np.linalg.norm(np.diff(recorded.own_m, axis=0, prepend=recorded.own_m[:1]), axis=1)
    return Walk(
        truth_m=recorded.truth_m @ np.array([[cosine, sine], [-sine, cosine]]),
        own_m=recorded.own_m,
        turn_rad=math.nan,
        t_s=recorded.t_s,
        distance_m=np.cumsum(steps_m),
    )


def _again(recorded: Tracked, number: int, draw: int) -> Receiver:
    """A receiver that errs for a peer as it does for the fuser."""
    rng = np.random.default_rng(100 * number + draw)
    turned(recorded, rng)
    return Receiver(rng, ERRORS)


def _fixes_alone_m(walk: Walk, receiver: Receiver, cut: int) -> Floats:
    """Errors of the last fix."""
    alone_m, last_m = np.zeros(len(walk)), np.zeros(2)
    for index in range(len(walk)):
        if index % RATE_HZ == 0 and index < cut:
            fix = receiver.fix(float(walk.t_s[index]), walk.truth_m[index])
            last_m = np.array([fix.north_m, fix.east_m])
        alone_m[index] = np.linalg.norm(last_m - walk.truth_m[index])
    return alone_m


def _best_turn_rad(walk: Walk) -> float:
    own = walk.own_m - walk.own_m.mean(axis=0)
    truth = walk.truth_m - walk.truth_m.mean(axis=0)
    own_plane, truth_plane = own[:, 0] + 1j * own[:, 1], truth[:, 0] + 1j * truth[:, 1]
    return float(np.angle(np.vdot(own_plane, truth_plane)))


def _tracked(walks: Path, tracks: Path) -> Iterator[Tracked]:
    for file in sorted(tracks.glob("*.csv")):
        truth_file = walks / file.stem / "truth.csv"
        if not truth_file.exists():
            continue
        track = np.genfromtxt(file, delimiter=",", names=True)
        truth = np.genfromtxt(truth_file, delimiter=",", names=True)
        t_s = np.arange(truth["t_s"][0], truth["t_s"][-1], 1.0 / RATE_HZ)
        own = [np.interp(t_s, track["t_s"], track[name]) for name in ("north_m", "east_m")]
        # The truth's axes are right-handed with z up: x for north makes -y east.
        north_m = np.interp(t_s, truth["t_s"], truth["x_m"])
        east_m = -np.interp(t_s, truth["t_s"], truth["y_m"])
        yield Tracked(file.stem, t_s, np.stack(own, axis=1), np.stack([north_m, east_m], axis=1))
