"""A heading error beyond its first order is stated, also where the first order cancels."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import ATTITUDE
from edge.tracker.foot.output.reported_covariance import (
    accumulate_heading_bias,
    stated_heading_variance,
)
from edge.tracker.foot.state import new_filter_state

pytestmark = pytest.mark.slow

CONFIG = config_record(EskfConfig())[0]
HEADING_STD_RAD = np.array([0.3, 0.6, 0.9])  # while each leg is walked
STEPS = 100


def walk(legs_m, std_rad=HEADING_STD_RAD, hidden_turn_rad=0.0):
    """Return the state after legs north (m) with a known deviation of the heading in each."""
    state = new_filter_state()[0]
    state["hidden_turn_rad"] = hidden_turn_rad
    for leg_m, std in zip(legs_m, std_rad, strict=True):
        state["covariance"][ATTITUDE + 2, ATTITUDE + 2] = std**2
        state["velocity_n_mps"] = [leg_m, 0.0, 0.0]
        for _ in range(STEPS):
            accumulate_heading_bias(state, 1.0 / STEPS, CONFIG)
    return state


def error_m(legs_m, deviations):
    """North and east error of a walk whose heading is off by so many deviations all the way."""
    off_rad = deviations * HEADING_STD_RAD
    return np.array([np.sum(legs_m * (np.cos(off_rad) - 1.0)), np.sum(legs_m * np.sin(off_rad))])


@pytest.mark.parametrize("deviations", [-1.7, -1.0, 1.0, 1.7])
def test_way_whose_first_and_second_order_cancel_is_still_stated(deviations):
    """A crawl in a loop ended 1.7 m from where it was stated within 0.2 m, with good quality."""
    second = 2.0 * (1.0 - np.exp(-0.5 * HEADING_STD_RAD**2))
    legs_m = np.cross(HEADING_STD_RAD, second)
    legs_m *= 10.0 / np.abs(legs_m).sum()
    state = walk(legs_m)
    assert state["second_order_n_m"] == pytest.approx([0.0, 0.0], abs=1e-9)
    std_m = np.sqrt(15.0 / 36.0) * abs(state["third_order_n_m"][1])
    off_m = error_m(legs_m, deviations)
    assert abs(off_m[1]) > 0.02
    assert abs(off_m[1]) < 3.0 * std_m


def test_small_heading_error_adds_next_to_nothing():
    state = walk([10.0, 0.0, 0.0], std_rad=[0.01, 0.0, 0.0])
    assert np.abs(state["second_order_n_m"]).max() < 2e-3
    assert np.abs(state["third_order_n_m"]).max() < 2e-5


def test_turn_that_clipped_rates_hide_counts_as_any_other():
    """A sprint's heading was stated as 28 degrees off, and its way as if it were 19."""
    filtered = walk([10.0, 0.0, 0.0], std_rad=[0.4, 0.0, 0.0])
    hidden = walk([10.0, 0.0, 0.0], std_rad=[0.0, 0.0, 0.0], hidden_turn_rad=0.4)
    assert stated_heading_variance(hidden, 1.0, CONFIG) == pytest.approx(0.16)
    for order in ("second_order_n_m", "third_order_n_m"):
        assert hidden[order] == pytest.approx(filtered[order])
        assert np.abs(hidden[order]).max() > 0.1
