"""The default tracker on simulated walks with known truth."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tests.bench.tracker.walk_errors import track, true_way_m
from tests.rig.inertial_walk import inertial_walk

SEEDS = range(6)
# 95 % of the mean of six chi-square values with two degrees of freedom: chi2(12) / 6.
NEES_BOUNDS = (4.404 / 6, 23.337 / 6)


@cache
def tracked(scenario, seed):
    """Rows and true positions in the tracker's frame: its start and its first heading."""
    found = inertial_walk(scenario, seed)
    rows = track(found.description, found.sensed(), "eskf")
    return rows, true_way_m(rows.quaternion_nb, found.truth)[0]


@pytest.mark.parametrize("scenario", ["square-60m", "rectangle", "j-shape"])
def test_walks_end_within_the_thesis_two_per_cent(scenario):
    """Huang 2009: 2 % of distance on 60 m squares; to be bettered on average."""
    per_cent = []
    for seed in SEEDS:
        rows, truth_n_m = tracked(scenario, seed)
        error_m = np.linalg.norm(rows.position_n_m[-1, :2] - truth_n_m[-1, :2])
        per_cent.append(100.0 * error_m / rows.distance_m[-1])
        assert rows.distance_m[-1] == pytest.approx(
            np.sum(np.linalg.norm(np.diff(truth_n_m[::100, :2], axis=0), axis=1)), rel=0.05
        )
    assert np.mean(per_cent) < 2.0
    assert np.median(per_cent) < 1.0


@pytest.mark.parametrize("scenario", ["square-60m", "j-shape"])
@pytest.mark.parametrize("share", [0.67, 1.0])
def test_stated_uncertainty_matches_the_errors(scenario, share):
    """The mean normalised error squared over the seeds stays inside its 95 % bounds."""
    nees = []
    for seed in SEEDS:
        rows, truth_n_m = tracked(scenario, seed)
        k = int(share * (len(rows) - 1))
        error_m = rows.position_n_m[k, :2] - truth_n_m[k, :2]
        nees.append(error_m @ np.linalg.solve(rows.position_cov_m2[k, :2, :2], error_m))
    assert NEES_BOUNDS[0] < np.mean(nees) < NEES_BOUNDS[1]


def test_stairs_keep_their_floors():
    rows, truth_n_m = tracked("stairs", 0)
    error_m = rows.position_n_m[:, 2] - truth_n_m[:, 2]
    assert np.ptp(truth_n_m[:, 2]) > 2.5
    assert np.sqrt(np.mean(error_m**2)) < 0.2


def test_strides_are_counted():
    rows, _ = tracked("square-60m", 0)
    assert 38 <= rows.steps[-1] <= 52
