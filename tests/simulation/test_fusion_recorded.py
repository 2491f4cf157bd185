"""The fuser on the tracks of recorded walks, with satellite fixes cut in.

Recipe: a walk is tracked as it is; its measured truth, turned by a drawn angle, gets a fix a
second with the receiver errors of ``base_station.bench.fusion_walks`` during the first 60 per
cent of the walk and none after.  The tracker's own frame has whatever heading it came to.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from base_station.bench.fusion_walks import RATE_HZ, Floats, Receiver, Scores, Walk, run
from base_station.fusion import FUSERS
from base_station.fusion.port import FuserKind
from edge.sources.recording import RecordingSource, read_truth
from edge.track_command import run_tracker
from edge.tracker import TRACKERS

TRIALS = ("31", "37", "40", "44")  # of ``footprints``: walks with a footprint at every stride
DRAWS = 6
WITH_GPS = 0.6


@dataclass(frozen=True)
class Tracked:
    """A recorded walk at the rate of position messages, from its first to its last footprint."""

    t_s: Floats
    own_m: Floats  # (n, 2) as tracked
    truth_m: Floats  # (n, 2) as measured, to be compared in any turn


@pytest.fixture(scope="module")
def tracked(walks: Path) -> list[Tracked]:
    return [_track(walks / "footprints" / trial) for trial in TRIALS]


@pytest.fixture(params=FUSERS, ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> FuserKind:
    found: FuserKind = request.param
    return found


def test_the_stated_region_holds_the_measured_footprints(
    kind: FuserKind, tracked: list[Tracked]
) -> None:
    with_gps, without = [], []
    for number, recorded in enumerate(tracked):
        for draw in range(DRAWS):
            walk, scores = _fuse(kind, recorded, np.random.default_rng(100 * number + draw))
            cut = round(WITH_GPS * len(walk))
            with_gps += scores.normalised2[2 * RATE_HZ : cut]
            without += scores.normalised2[cut:]
    assert np.mean(np.array(with_gps) < 5.991) > 0.9
    assert np.mean(np.array(without) < 5.991) > 0.9


def test_the_path_goes_on_where_the_fixes_end(kind: FuserKind, tracked: list[Tracked]) -> None:
    """No jump at the seam, and the way after it is no worse than the fixes before it were."""
    for number, recorded in enumerate(tracked):
        walk, scores = _fuse(kind, recorded, np.random.default_rng(number))
        cut = round(WITH_GPS * len(walk))
        steps_m = np.abs(np.diff(scores.error_m[cut - 1 :]))
        assert steps_m.max() < 1.5
        assert scores.error_m[-1] < 10.0


def _fuse(kind: FuserKind, recorded: Tracked, rng: np.random.Generator) -> tuple[Walk, Scores]:
    angle_rad = rng.uniform(-math.pi, math.pi)
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    steps_m = np.linalg.norm(np.diff(recorded.own_m, axis=0, prepend=recorded.own_m[:1]), axis=1)
    walk = Walk(
        truth_m=recorded.truth_m @ np.array([[cosine, sine], [-sine, cosine]]),
        own_m=recorded.own_m,
        turn_rad=math.nan,
        t_s=recorded.t_s,
        distance_m=np.cumsum(steps_m),
    )
    until_s = float(recorded.t_s[round(WITH_GPS * len(walk))])
    return walk, run(kind.new(), walk, Receiver(rng), (0.0, until_s))


def _track(trial: Path) -> Tracked:
    source = RecordingSource(trial)
    rows = run_tracker(source, TRACKERS[0].name, quiet=True)
    truth = read_truth(trial)
    assert truth is not None
    t_s = np.arange(truth.t_s[0], truth.t_s[-1], 1.0 / RATE_HZ)
    rows_s = rows.t_ns * 1e-9
    own_m = [np.interp(t_s, rows_s, rows.position_n_m[:, axis]) for axis in (0, 1)]
    truth_m = [np.interp(t_s, truth.t_s, truth.position_n_m[:, axis]) for axis in (0, 1)]
    return Tracked(t_s, np.stack(own_m, axis=1), np.stack(truth_m, axis=1))
