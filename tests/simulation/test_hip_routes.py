"""The hip's tracker on the routes of its document, simulated."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench.tracker.scoring import score_track
from tests.bench.tracker.simulated_walks import track_simulated

SEEDS = range(3)


@pytest.mark.parametrize(("route", "way_m"), [("straight-40m", 40.0), ("corridors-124m", 124.0)])
def test_distance_error_is_below_the_figure_of_the_thesis(route, way_m):
    """Hettiarachchige Don 2016: 4.3 % where step and heading has 6.0 %."""
    off = []
    for seed in SEEDS:
        rows, truth = track_simulated(f"{route}?seed={seed}", "hip")
        score = score_track(rows, truth, closed_loop=False)
        assert score.coverage_95_from_start is not None
        assert score.coverage_95_from_start > 0.9
        off.append(abs(rows.distance_m[-1] - way_m) / way_m)
    assert np.mean(off) < 0.043


def test_corridors_keep_their_right_angles():
    rows, truth = track_simulated("corridor-174m?seed=0", "hip-corridors")
    score = score_track(rows, truth, closed_loop=False)
    assert score.per_cent_of_distance is not None
    assert score.per_cent_of_distance < 2.0
