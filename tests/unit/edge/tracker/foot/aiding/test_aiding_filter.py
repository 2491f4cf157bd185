"""The small filters beside the main one, against the textbook forms."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.aiding.aiding_filter import equivalent_measurement, measure, sync_variance

COUNT = 5


def random_covariance(seed, size=COUNT):
    root = np.random.default_rng(seed).standard_normal((size, size))
    return root @ root.T


def test_a_measurement_is_the_joseph_form():
    noise = np.random.default_rng(1)
    before, row, estimate = random_covariance(1), noise.standard_normal(COUNT), np.zeros(COUNT)
    variance = 0.3
    gain = before @ row / (row @ before @ row + variance)
    kept = np.eye(COUNT) - np.outer(gain, row)
    after = before.copy()
    measure(estimate, after, row, 2.0, variance, np.zeros(COUNT))
    expected = kept @ before @ kept.T + variance * np.outer(gain, gain)
    np.testing.assert_allclose(after, expected, atol=1e-12)
    np.testing.assert_allclose(estimate, 2.0 * gain)


def test_drift_of_the_main_filter_is_added_to_the_first_state_alone():
    before = random_covariance(2)
    after = before.copy()
    sync_variance(after, before[0, 0] + 0.4)
    np.testing.assert_allclose(after - before, 0.4 * np.eye(COUNT)[0][:, None] * np.eye(COUNT)[0])


def test_update_of_the_main_filter_is_a_measurement_of_the_first_state():
    before = random_covariance(3)
    variance = 0.25 * before[0, 0]
    after, expected = before.copy(), before.copy()
    sync_variance(after, variance)
    worth = 1.0 / (1.0 / variance - 1.0 / before[0, 0])
    measure(np.zeros(COUNT), expected, np.eye(COUNT)[0], 0.0, worth, np.zeros(COUNT))
    np.testing.assert_allclose(after, expected, atol=1e-12)


@pytest.mark.parametrize("share", [0.9, 0.3])
def test_the_main_filter_is_brought_to_just_what_the_side_filter_knows(share):
    side = random_covariance(4)
    prior = side[0, 0] / share
    estimate = np.array([0.02, 1.0, 0.0, 0.0, 0.0])
    residual, variance = equivalent_measurement(estimate, side, prior)
    gain = prior / (prior + variance)
    assert gain * residual == pytest.approx(0.02)
    assert (1.0 - gain) * prior == pytest.approx(side[0, 0])
    assert estimate[0] == 0.0


def test_a_look_that_tells_nothing_is_not_handed_over():
    side = random_covariance(5)
    estimate = np.ones(COUNT)
    assert equivalent_measurement(estimate, side, side[0, 0])[1] == np.inf
    assert estimate[0] == 1.0
