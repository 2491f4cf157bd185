"""The waist's tracker on the routes of its document, simulated."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tests.bench.tracker.scoring import score_track
from tests.bench.tracker.simulated_walks import track_simulated


@cache
def tracked(route):
    return track_simulated(route, "waist")


@pytest.mark.parametrize("route", ["corridor-174m", "three-turns-60m"])
@pytest.mark.parametrize("seed", range(3))
def test_errors_stay_below_three_per_cent_of_the_distance(route, seed):
    """Li et al. 2014: 5 m at most on 174 m."""
    rows, truth = tracked(f"{route}?seed={seed}")
    score = score_track(rows, truth, closed_loop=False)
    assert score.per_cent_of_distance is not None
    assert score.coverage_95_from_start is not None
    assert score.per_cent_of_distance < 3.0
    assert score.coverage_95_from_start > 0.9
    assert score.silently_wrong == 0.0


def test_floors_of_four_metres_are_distinguished():
    rows, truth = tracked("five-floors?seed=0")
    height_m = np.interp(truth.t_s, rows.t_ns * 1e-9, -rows.position_n_m[:, 2])
    error_m = height_m - height_m[0] + truth.position_n_m[:, 2] - truth.position_n_m[0, 2]
    assert np.abs(error_m).max() < 1.0  # a quarter of a storey
    assert np.ptp(height_m) == pytest.approx(16.0, abs=0.6)


def test_stairs_are_stated_as_less_certain():
    """The formula of the step length is for level ways: half as long on stairs."""
    rows, truth = tracked("five-floors?seed=0")
    score = score_track(rows, truth, closed_loop=False)
    assert score.coverage_95_from_start is not None
    assert score.coverage_95_from_start > 0.9
