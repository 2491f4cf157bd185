"""``muster bench fusion``: accuracy of the station's positions, beside simpler methods.

Simulated incidents, each with a seed of its own: a building, six people, twenty minutes
(``tests.rig.incident``).  All begin at the engine, whose place the commander has said and
whose receiver the station hears; once nobody says so.  The peers are given a heading that is right
to some five degrees; the fuser has to find it.  One of them is the rule of the documents, as the
station has it beside its own fuser (``base_station.fusion.gps_switching``).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from base_station.fusion import FUSERS
from base_station.fusion.gps_switching import GpsSwitching
from base_station.fusion.interface import CompassHeading, FuserKind
from base_station.fusion.smoothing import SMOOTHERS
from shared.bench_figures import FiguresFile, write_figures
from shared.errors import UserError
from tests.bench.fusion import smoothing
from tests.bench.fusion.kept_paths import PathKeeping, engine_evidence
from tests.bench.fusion.recorded_walks import print_recorded
from tests.rig.incident.cramer_rao_bound import bound_m2, draw_errors_m
from tests.rig.incident.people import PEOPLE
from tests.rig.incident.run import Known, Person, Timing, draw_incident, fuse_all
from tests.rig.incident.scores import (
    ASTRAY,
    ERROR_STAGES,
    FAR_M,
    HELD_STAGES,
    FloorScores,
    Scores,
    normalised2,
)
from tests.rig.incident.tracked import tracked_walks
from tests.rig.incident.walking import Walkers, drawn_walks
from tests.rig.parallel_work import side_by_side

Floats = NDArray[np.float64]

PEER_HEADING_STD_RAD = math.radians(5.0)
WITH_PLAN, WITHOUT = "with the plan", "without a plan"
UNTOLD = "without a plan, nor where the engine is"
KNOWN = {WITH_PLAN: Known(plan=True), WITHOUT: Known(plan=False), UNTOLD: Known(False, False)}
BOUND = "best by path and fixes, without a plan"
FIXES, PATH, SWITCHING = "fixes alone", "path alone", "switching"


@dataclass(frozen=True, slots=True)
class FusionReport:
    """Circular errors by ISO/IEC 18305 in metres, by way of knowing and stage."""

    fuser: str
    incidents: int
    ce50_m: dict[str, dict[str, float]]
    ce95_m: dict[str, dict[str, float]]
    seam_95_m: dict[str, float]  # jump on coming out, of 95 % of people at most
    held_95: dict[str, dict[str, float]]  # part of the time that the stated region held the truth
    astray: dict[str, dict[str, float]]  # part of the time far off, and sure not to be
    floor_right: float  # part of the time inside, not on stairs
    floor_stated: float  # and the mean of the stated probability
    heading_walked_m: dict[str, float]  # walked with fixes until the heading is solved
    step_us: dict[str, float]  # of a position, and of one with a fix
    afterwards: smoothing.SmoothingReport


def bench_fusion(
    incidents: Annotated[
        int, typer.Option(min=1, help="Simulated incidents, of six people each.")
    ] = 10,
    seed: Annotated[int, typer.Option(help="Seed of the first incident.")] = 1,
    tracked: Annotated[
        bool, typer.Option("--tracked", help="Units track simulated sensors.")
    ] = False,
    walks: Annotated[
        Path | None, typer.Option(help="Recorded trials with truth, instead; needs --tracks.")
    ] = None,
    tracks: Annotated[
        Path | None, typer.Option(help="Their tracks: TRIAL.csv as muster track writes them.")
    ] = None,
    json_file: FiguresFile = None,
) -> None:
    """Measure error and honesty of the fused position over simulated incidents, beside satellite
    fixes alone, the unit's own path alone, and switching between them.
    """
    if (walks is None) != (tracks is None):
        raise UserError("recorded walks need both: --walks with the trials, --tracks with tracks")
    if walks is not None and tracks is not None:
        print_recorded(FUSERS[0], walks, tracks)
        return
    report = measure(FUSERS[0], incidents, seed, tracked_walks if tracked else drawn_walks)
    Console().print(_errors_table(report))
    Console().print(_held_table(report))
    Console().print(_figures_table(report))
    for table in smoothing.tables_of(report.afterwards):
        Console().print(table)
    write_figures(json_file, report)


def measure(
    kind: FuserKind, incidents: int, seed: int, walkers: Walkers = drawn_walks
) -> FusionReport:
    tally = _Tally(kind)
    seeds = range(seed, seed + incidents)
    for taken in side_by_side(partial(_taken, kind, walkers), seeds, "Incidents"):
        tally.add(taken)
    return tally.report(incidents, seed)


def _taken(kind: FuserKind, walkers: Walkers, seed: int) -> _Tally:
    tally = _Tally(kind)
    rng = np.random.default_rng(seed)
    tally.take(draw_incident(rng, walkers), rng)
    return tally


class _Tally:
    """Takes incidents through every way of knowing."""

    def __init__(self, kind: FuserKind) -> None:
        self._kind = kind
        names = (*KNOWN, BOUND, FIXES, PATH, SWITCHING)
        self._ways = {name: Scores() for name in names}
        self._timing, self._right = Timing(), FloorScores()
        self._afterwards = smoothing.SmoothingScores(SMOOTHERS[0])
        self._walked_m: list[float] = []

    def take(self, people: list[Person], rng: np.random.Generator) -> None:
        """One drawn incident."""
        for name in KNOWN:
            self._fuse(name, people, rng)
        for person in people:
            best_m2 = bound_m2(person.truth, person.fixes, person.engine_fixes, person.building)
            live_m, then_m = (draw_errors_m(rng, one_m2) for one_m2 in best_m2)
            self._ways[BOUND].note(person.truth, person.truth.place_m[:, :2] + live_m, None)
            self._afterwards.note_bound(person.truth, live_m, then_m)
            turn_rad = person.turn_rad + rng.normal(0.0, PEER_HEADING_STD_RAD)
            for name, places_m in _alone(person, turn_rad).items():
                self._ways[name].note(person.truth, places_m, None)
            self._ways[SWITCHING].note(person.truth, *_switching(person, turn_rad))

    def add(self, other: _Tally) -> None:
        """The incidents that another one has taken, behind one's own."""
        for name, scores in other._ways.items():
            self._ways[name].add(scores)
        self._timing.add(other._timing)
        self._right.add(other._right)
        self._afterwards.add(other._afterwards)
        self._walked_m += other._walked_m

    def _fuse(self, name: str, people: list[Person], rng: np.random.Generator) -> None:
        known, keeping = KNOWN[name], PathKeeping(self._kind)
        runs = fuse_all(keeping, people, self._timing, known)
        for person, run in zip(people, runs, strict=True):
            self._ways[name].note(person.truth, run.places_m, run.normalised2)
            if known.plan:
                self._right.note(person.truth, person.building, run.floors, run.surenesses)
            else:
                self._walked_m.append(run.heading_walked_m)
        evidence = keeping.evidence(runs) | (engine_evidence(people[0]) if known.engine else {})
        self._afterwards.note(name, people, runs, evidence, rng)

    def report(self, incidents: int, seed: int) -> FusionReport:
        ways, timing, walked_m = self._ways, self._timing, self._walked_m
        return FusionReport(
            fuser=self._kind.name,
            incidents=incidents,
            ce50_m={name: _percentiles(way, 50.0) for name, way in ways.items()},
            ce95_m={name: _percentiles(way, 95.0) for name, way in ways.items()},
            seam_95_m={name: float(np.percentile(way.seams_m, 95.0)) for name, way in ways.items()},
            held_95={
                name: {stage: ways[name].held_95(stage) for stage in HELD_STAGES}
                for name in (*KNOWN, SWITCHING)
            },
            astray={name: {how: ways[name].part_astray(how) for how in ASTRAY} for name in KNOWN},
            floor_right=self._right.part_right(),
            floor_stated=self._right.part_stated(),
            heading_walked_m={
                "median": float(np.median(walked_m)),
                "95 %": float(np.percentile(walked_m, 95.0)),
                "worst": float(np.max(walked_m)),
            },
            step_us={
                "position": float(np.median(timing.steps_ns)) / 1e3,
                "position and fix": float(np.median(timing.fixes_ns)) / 1e3,
            },
            afterwards=self._afterwards.report(seed),
        )


def _alone(person: Person, turn_rad: float) -> dict[str, Floats]:
    """Positions by fixes alone and by the path alone, row by row."""
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    own_m = np.array([(position.north_m, position.east_m) for position in person.positions])
    path_m = own_m @ np.array([[cosine, sine], [-sine, cosine]])
    fixes_m, last_m = np.zeros_like(path_m), np.zeros(2)
    for row in range(len(path_m)):
        fix = person.fixes.get(row)
        if fix is not None:
            last_m = np.array([fix.north_m, fix.east_m])
        fixes_m[row] = last_m
    return {FIXES: fixes_m, PATH: path_m + person.truth.place_m[0, :2] - path_m[0]}


def _switching(person: Person, turn_rad: float) -> tuple[Floats, Floats]:
    """Positions by the documents' rule, (n, 2), and normalised squared errors, (n,).  It
    has the raw fixes, and a compass once, at the beginning.
    """
    fuser, truth_m = GpsSwitching().new(), person.truth.place_m[:, :2]
    fuser.update_heading(CompassHeading(turn_rad, PEER_HEADING_STD_RAD))
    places_m, normalised = np.zeros_like(truth_m), np.zeros(len(truth_m))
    for row, position in enumerate(person.positions):
        fuser.predict(position)
        fix = person.fixes.get(row)
        if fix is not None:
            fuser.update_gnss(fix)
        estimate = fuser.estimate()
        assert estimate is not None
        places_m[row] = estimate.north_m, estimate.east_m
        normalised[row] = normalised2(estimate, places_m[row] - truth_m[row])
    return places_m, normalised


def _percentiles(scores: Scores, percent: float) -> dict[str, float]:
    return {stage: scores.ce_m(stage, percent) for stage in ERROR_STAGES}


def _errors_table(report: FusionReport) -> Table:
    table = Table(title=f"{report.incidents} incidents of {PEOPLE} people: CE50 / CE95 in metres")
    table.add_column("")
    for heading in (*ERROR_STAGES, "jump at the door"):
        table.add_column(heading, justify="right")
    for name, ce50_m in report.ce50_m.items():
        cells = [
            f"{ce50_m[stage]:.1f} / {report.ce95_m[name][stage]:.1f}" for stage in ERROR_STAGES
        ]
        title = f"{report.fuser}, {name}" if name in KNOWN else name
        seam = "" if name == BOUND else f"{report.seam_95_m[name]:.1f}"
        table.add_row(title, *cells, seam)
    table.add_row("to reach", "2.0", "3.0", "", "")
    return table


def _held_table(report: FusionReport) -> Table:
    table = Table(title="The stated 95 % region holds the truth (to reach: 92 to 98 %)")
    table.add_column("")
    for stage in HELD_STAGES:
        table.add_column(stage, justify="right")
    for name, held in report.held_95.items():
        table.add_row(name, *(f"{held[stage]:.1%}" for stage in HELD_STAGES))
    return table


def _figures_table(report: FusionReport) -> Table:
    table = Table(title="And")
    table.add_column("")
    table.add_column("measured", justify="right")
    table.add_column("to reach", justify="right")
    for name, parts in report.astray.items():
        for how, part in parts.items():
            table.add_row(f"over {FAR_M:.0f} m off and {how}, {name}", f"{part:.2%}", "")
    table.add_row("floor right", f"{report.floor_right:.2%}", "99 %")
    table.add_row("floor right, as stated", f"{report.floor_stated:.2%}", "")
    for which, walked_m in report.heading_walked_m.items():
        table.add_row(f"heading solved after a walk of, {which}", f"{walked_m:.1f} m", "25 m")
    for what, step_us in report.step_us.items():
        table.add_row(f"step, {what}, median", f"{step_us:.0f} us", "250 us")
    return table
