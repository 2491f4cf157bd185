"""Consistent sets of places: the same in one solution or one by one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from base_station.fusion.smoothing.consistency import (
    ConditionalPrediction,
    Prediction,
    consistent_set,
    strongest_conflict,
)

Floats = NDArray[np.float64]


def expected_of(count: int, off_m: dict[int, float] | None = None) -> Prediction:
    """Places along a path that is known badly as a whole; some lie off to the east."""
    rng = np.random.default_rng(count)
    apart_s = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    along_m2 = 1e4 + 4.0 * np.exp(-apart_s.astype(np.float64) / 5.0)
    covariance_m2 = np.kron(along_m2, [[1.0, 0.3], [0.3, 2.0]]).astype(np.float64)
    seen_m = rng.multivariate_normal(np.zeros(2 * count), covariance_m2)
    for one, east_m in (off_m or {}).items():
        seen_m[2 * one + 1] += east_m
    mean_m, noise_m2 = np.zeros(2 * count), rng.uniform(0.3, 1.0, count) ** 2
    return Prediction(mean_m, covariance_m2, seen_m, noise_m2)


def at_once(expected: Prediction, used: Sequence[int], of: int) -> tuple[Floats, Floats]:
    """A normal distribution, conditioned."""
    rows = [row for one in used for row in (2 * one, 2 * one + 1)]
    pair = [2 * of, 2 * of + 1]
    total = expected.covariance_m2 + np.diag(np.repeat(expected.noise_m2, 2))
    gain = np.linalg.solve(total[np.ix_(rows, rows)], total[np.ix_(rows, pair)]).T
    off = expected.seen_m - expected.mean_m
    return off[pair] - gain @ off[rows], total[np.ix_(pair, pair)] - gain @ total[
        np.ix_(rows, pair)
    ]


@pytest.mark.parametrize("used", [[], [3], [0, 1, 2], [9, 4, 0, 7]])
def test_sequential_expectation_equals_the_joint_one(used: list[int]) -> None:
    expected = expected_of(12)
    given = ConditionalPrediction(expected, used)
    for one in set(range(12)) - set(used):
        innovation, covariance = at_once(expected, used, one)
        assert given.of(one)[0] == pytest.approx(innovation, abs=1e-6)
        assert given.of(one)[1] == pytest.approx(covariance, abs=1e-6)
        distance2 = innovation @ np.linalg.solve(covariance, innovation)
        assert given.distance2(one) == pytest.approx(distance2, rel=1e-6)


@pytest.mark.slow
def test_contradicting_places_among_hundreds_are_left_out() -> None:
    off_m = {0: 60.0, 50: -80.0, 199: 70.0}
    used = consistent_set(expected_of(200, off_m))
    assert set(range(200)) - set(used) == set(off_m)


def test_strongest_conflict_of_a_place_is_named() -> None:
    expected = expected_of(6, {2: 40.0})
    used = [0, 1, 3, 4, 5]
    distances2 = []
    for one in used:
        innovation, covariance = at_once(expected, [one], 2)
        distances2.append(innovation @ np.linalg.solve(covariance, innovation))
    assert strongest_conflict(expected, used, 2) == used[int(np.argmax(distances2))]
    assert strongest_conflict(expected, [], 2) is None
    assert strongest_conflict(expected_of(6, {2: 4000.0}), used, 2) is None
