"""Means over an interval against exact motions."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.filter.integration import mean_readings
from edge.tracker.foot.state import new_filter_state, new_progress
from edge.tracker.preprocessing.sample_ring import RING
from tests.bench.tracker.reference_filter import turn


def state_at(t_s, gyro, accel, k):
    ring = np.zeros(8, RING)
    ring["t_s"][: len(t_s)] = t_s
    ring["period_s"] = 0.1
    ring["rest_norm_mps2"] = EskfConfig().gravity_mps2
    ring["gyro_radps"][: len(t_s)] = gyro
    ring["accel_mps2"][: len(t_s)] = accel
    progress = new_progress()
    progress["measured"] = len(t_s)
    state = new_filter_state()[0]
    mean_readings(ring, progress[0], state, k, EskfConfig())
    return state


def means_of(t_s, gyro, accel, k):
    state = state_at(t_s, gyro, accel, k)
    return state["gyro_radps"], state["accel_mps2"]


@pytest.mark.slow
def test_a_cubic_is_averaged_exactly():
    t_s = np.array([0.0, 0.1, 0.2, 0.3])
    cubic = np.poly1d([40.0, -9.0, 3.0, 1.0])
    readings = np.column_stack((cubic(t_s), np.zeros(4), np.zeros(4)))
    gyro, accel = means_of(t_s, readings, readings, 2)
    expected = (cubic.integ()(0.2) - cubic.integ()(0.1)) / 0.1
    assert gyro[0] == pytest.approx(expected)
    assert accel[0] == pytest.approx(expected)


def test_only_what_bends_more_than_a_cubic_is_unseen():
    t_s = 0.1 * np.arange(6)
    quiet = np.zeros((6, 3))

    def unseen_var(readings, k=3):
        force = np.column_stack((readings, np.zeros((len(readings), 2))))
        return state_at(t_s[: len(readings)], quiet[: len(readings)], force, k)[
            "force_curvature_var"
        ]

    cubic = np.poly1d([40.0, -9.0, 3.0, 1.0])(t_s)
    strike = cubic + np.array([0.0, 0.0, 0.0, 50.0, 0.0, 0.0])
    assert unseen_var(cubic) == pytest.approx(0.0, abs=1e-20)
    quintic = np.poly1d(np.polyfit(t_s, strike, 5))
    mean = (quintic.integ()(0.3) - quintic.integ()(0.2)) / 0.1
    _, by_cubic = means_of(t_s, quiet, np.column_stack((strike, np.zeros((6, 2)))), 3)
    assert unseen_var(strike) == pytest.approx((mean - by_cubic[0]) ** 2)
    assert unseen_var(strike[:5]) == 0.0
    assert unseen_var(strike, k=2) == 0.0


@pytest.mark.parametrize("t_s", [(0.0, 0.08, 0.19, 0.28), (0.0, 0.11, 0.2, 0.32)])
def test_stamps_that_jitter_are_of_even_samples(t_s):
    readings = np.column_stack(([1.0, 2.0, 5.0, 9.0], np.zeros(4), np.zeros(4)))
    jittering, _ = means_of(np.array(t_s), readings, readings, 2)
    even, _ = means_of(0.1 * np.arange(4), readings, readings, 2)
    assert jittering[0] == even[0]


@pytest.mark.parametrize(
    "t_s",
    [(0.0, 0.1, 0.3, 0.4), (0.0, 0.3, 0.4, 0.5), (0.0, 0.1, 0.44, 0.64), (0.0, 0.1, 0.2, 0.5)],
)
def test_a_cubic_is_averaged_exactly_where_one_or_two_samples_are_missing(t_s):
    cubic = np.poly1d([40.0, -9.0, 3.0, 1.0])
    readings = np.column_stack((cubic(t_s), np.zeros(4), np.zeros(4)))
    state = state_at(np.array(t_s), readings, readings, 2)
    expected = (cubic.integ()(t_s[2]) - cubic.integ()(t_s[1])) / (t_s[2] - t_s[1])
    assert state["gyro_radps"][0] == pytest.approx(expected)
    assert state["accel_mps2"][0] == pytest.approx(expected)
    by_line = 0.5 * (cubic(t_s[1]) + cubic(t_s[2]))
    assert state["gyro_curvature_var"] == pytest.approx((expected - by_line) ** 2)


@pytest.mark.parametrize(
    "t_s",
    [
        (0.0, 0.1, 0.46, 0.56),  # three samples are missing
        (0.0, 0.36, 0.46, 0.56),
        (0.0, 0.1, 0.2, 0.56),
        (0.0, 0.05, 0.15, 0.25),  # a stamp is wrong
        (0.0, 0.1, 0.2, 0.25),
        (0.0, 0.1, 0.15, 0.25),
    ],
)
def test_neighbours_too_far_or_too_near_or_none_leave_the_trapezoid(t_s):
    readings = np.column_stack(([1.0, 2.0, 5.0, 9.0], np.zeros(4), np.zeros(4)))
    for count in (4, 3):
        gyro, _ = means_of(np.array(t_s[:count]), readings[:count], readings[:count], 2)
        assert gyro[0] == pytest.approx(3.5)


def test_a_moving_axis_turns_further_than_its_mean():
    """Coning: many small turns of a rate that changes evenly, against one."""
    first, last = np.array([3.0, 0.0, 1.0]), np.array([0.0, 4.0, 1.5])
    t_s = 0.02 * np.arange(4)
    # Evenly changing over all four samples; the interval lies between the inner two.
    gyro = first + (last - first) * (np.arange(4) - 1)[:, None]
    exact = np.eye(3)
    for u in (np.arange(2000) + 0.5) / 2000:
        exact = exact @ turn((first + u * (last - first)) * 0.02 / 2000)
    rate, _ = means_of(t_s, gyro, np.zeros((4, 3)), 2)
    with_coning = np.abs(turn(rate * 0.02) - exact).max()
    without = np.abs(turn(0.5 * (first + last) * 0.02) - exact).max()
    assert with_coning < 0.05 * without
