"""No less is reported of the bias before a rest than what rests and landings leave of it."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, GYRO_BIAS, VELOCITY
from edge.tracker.foot.filter.initial_gyro_bias import (
    inflate_bias,
    inform_by_landing,
    inform_by_rest,
)
from edge.tracker.foot.state import new_filter_state, new_progress

CONFIG = EskfConfig()
PRIOR = CONFIG.start.gyro_bias_std_radps**2
SINCE_S = 100.0  # for which the bias has turned the heading


def believing(share):
    """A filter that takes the bias to be known to ``share`` of its first variance."""
    state = new_filter_state()[0]
    state["unobserved_bias_std_radps"] = CONFIG.start.data_sheet_bias_std_radps
    state["least_known_axis_b"] = [0.0, 0.0, 1.0]
    for i in range(3):
        state["covariance"][GYRO_BIAS + i, GYRO_BIAS + i] = share * PRIOR
    yaw, bias = ATTITUDE + 2, GYRO_BIAS + 2
    state["covariance"][yaw, bias] = state["covariance"][bias, yaw] = -SINCE_S * share * PRIOR
    return state


def reported_heading_rad(state):
    inflate_bias(state, CONFIG)
    return abs(float(state["unobserved_effect"][2]))


@pytest.mark.slow
def test_belief_beyond_what_was_shown_narrows_nothing():
    assert reported_heading_rad(believing(0.1)) == pytest.approx(
        SINCE_S * CONFIG.start.data_sheet_bias_std_radps
    )


@pytest.mark.slow
def test_a_landing_tells_the_more_of_the_bias_the_longer_the_stride_and_the_surer_the_velocity():
    std_mps, stride_m = 0.02, 5.0
    state, progress = believing(0.1), new_progress()[0]
    state["position_n_m"] = [3.0, 4.0, 0.0]
    for i in range(2):
        state["covariance"][VELOCITY + i, VELOCITY + i] = std_mps**2
    inform_by_landing(progress, state)
    left = 1.0 / (1.0 + PRIOR * (stride_m / std_mps) ** 2)
    assert 0.1 < left < 0.9  # or the share is not that of the landing
    assert reported_heading_rad(state) == pytest.approx(
        left * SINCE_S * CONFIG.start.data_sheet_bias_std_radps
    )


@pytest.mark.slow
def test_a_rest_shows_the_bias():
    state = believing(0.01)
    for _ in range(200):
        inform_by_rest(state, PRIOR)
    assert reported_heading_rad(state) == 0.0
    assert state["bias_observed"]


@pytest.mark.slow
def test_unknown_bias_is_reported_however_much_was_shown():
    state = believing(0.5)
    inform_by_rest(state, 1e-3 * PRIOR)
    assert reported_heading_rad(state) == pytest.approx(
        0.5 * SINCE_S * CONFIG.start.data_sheet_bias_std_radps
    )
    assert np.isfinite(state["unobserved_effect"]).all()
