"""The fuser on tracks of recorded walks with simulated satellite fixes, made as in
``tests.bench.fusion.recorded_walks``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from base_station.fusion.interface import FuserKind
from edge.app.track import run_tracker, write_csv
from edge.sources.recording import RecordingSource, read_truth
from edge.tracker.registry import TRACKERS
from shared.errors import UserError
from tests.bench.fusion.recorded_walks import (
    WITH_GPS,
    Tracked,
    fuse_recorded,
    print_recorded,
    turned,
)
from tests.bench.fusion.simulated_walks import RATE_HZ, Receiver, Scores, Walk, run

TRIALS = ("31", "37", "40", "44")  # of ``footprints``: walks with a footprint at every stride


@pytest.fixture(scope="module")
def tracked(walks: Path) -> list[Tracked]:
    return [_track(walks / "footprints" / trial) for trial in TRIALS]


def test_the_stated_region_holds_the_measured_footprints(
    kind: FuserKind, tracked: list[Tracked]
) -> None:
    scores = fuse_recorded(kind, tracked)
    assert np.mean(scores.held_with) > 0.9
    assert np.mean(scores.held_after) > 0.9


def test_fusion_is_better_than_fixes_or_dead_reckoning_alone(
    kind: FuserKind, tracked: list[Tracked]
) -> None:
    """The walks are too short for a path carried on from one fix to fall far behind after it."""
    scores = fuse_recorded(kind, tracked, draws=3)
    for way in ("fixes alone", "switching"):
        assert np.median(scores.with_m["fused"]) < np.median(scores.with_m[way])
    alone_m = scores.after_m["fixes alone"]
    assert np.percentile(scores.after_m["fused"], 95) < 0.5 * np.percentile(alone_m, 95)


def test_tracks_are_read_in_the_format_of_the_tracker(
    kind: FuserKind, walks: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    trials = walks / "footprints"
    rows = run_tracker(RecordingSource(trials / "31"), TRACKERS[0].name, quiet=True)
    write_csv(rows, tmp_path / "31.csv")
    print_recorded(kind, trials, tmp_path)
    assert "1 recorded walks" in capsys.readouterr().out
    with pytest.raises(UserError, match="muster track"):
        print_recorded(kind, trials, tmp_path / "nothing")


def test_path_continues_without_a_jump_after_the_last_fix(
    kind: FuserKind, tracked: list[Tracked]
) -> None:
    """No jump at the seam, and the way after it is no worse than the fixes before it were."""
    for number, recorded in enumerate(tracked):
        walk, scores = _fuse(kind, recorded, np.random.default_rng(number))
        cut = round(WITH_GPS * len(walk))
        steps_m = np.abs(np.diff(scores.error_m[cut - 1 :]))
        assert steps_m.max() < 1.5
        assert scores.error_m[-1] < 10.0


def _fuse(kind: FuserKind, recorded: Tracked, rng: np.random.Generator) -> tuple[Walk, Scores]:
    walk = turned(recorded, rng)
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
    return Tracked(trial.name, t_s, np.stack(own_m, axis=1), np.stack(truth_m, axis=1))
