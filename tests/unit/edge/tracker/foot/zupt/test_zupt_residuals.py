"""Noise of an ordinary stride, stated as the landings show it."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import ATTITUDE, POSITION, VELOCITY
from edge.tracker.foot.state import STEP, new_filter_state
from edge.tracker.foot.zupt.zupt_residuals import (
    on_footfall,
    on_lift_off,
    reported_gain_inflation,
    scale_error_inflation,
)
from edge.tracker.preprocessing.sample_ring import new_ring

HEADING = ATTITUDE + 2
CONFIG = config_record(EskfConfig())[0]


def stride(state, *, adds_m2, adds_rad2, faulty=False):
    """One stride of a state whose covariance grows by so much."""
    state["faulty_stride"] = faulty
    state["covariance"][POSITION, POSITION] += adds_m2
    state["covariance"][HEADING, HEADING] += adds_rad2
    on_lift_off(state, CONFIG)


def test_all_noise_of_a_walk_without_a_fault_is_ordinary():
    state = new_filter_state()[0]
    for _ in range(20):
        stride(state, adds_m2=0.01, adds_rad2=1e-4)
    assert state["ordinary_m2"] == pytest.approx(state["noise_m2"])


def test_residual_of_a_faulty_stride_is_excluded():
    state = new_filter_state()[0]
    stride(state, adds_m2=0.01, adds_rad2=1e-4)
    stride(state, adds_m2=0.5, adds_rad2=0.0, faulty=True)
    assert state["ordinary_m2"] == pytest.approx(0.01)


def test_the_heading_that_a_fault_left_in_doubt_goes_on_to_count():
    """The strides after a hole are ordinary, and where they lead is not."""
    state = new_filter_state()[0]
    for _ in range(10):
        stride(state, adds_m2=0.001, adds_rad2=1e-5)
    stride(state, adds_m2=0.01, adds_rad2=0.04, faulty=True)
    before_m2 = state["ordinary_m2"]
    for _ in range(10):
        stride(state, adds_m2=0.05, adds_rad2=1e-5)
    assert state["ordinary_m2"] - before_m2 < 0.01 * 0.5


def gains(residual, least_share=0.0, *, compass=False):
    """Share of the gains' assumed variance that is reported at a mean residual of landings."""
    state = new_filter_state()[0]
    state["mean_scale_residual"] = residual
    state["scale_errors"]["least_share"] = least_share
    state["scale_errors"]["compass_used"] = compass
    return scale_error_inflation(state, CONFIG)


@pytest.mark.slow
def test_gains_are_reported_as_landings_show_them():
    config = EskfConfig()
    assert gains(config.residuals.zupt_residual_usual) == pytest.approx(1.0)
    assert gains(0.014) < 0.2 < gains(0.02) < 0.6
    assert gains(0.05) > 2.0


@pytest.mark.slow
def test_quiet_landings_do_not_make_gains_better_than_the_best_or_than_described():
    assert gains(0.008, least_share=0.03) == pytest.approx(0.03)
    assert gains(0.014, least_share=1.0) == pytest.approx(1.0)


@pytest.mark.slow
def test_gains_that_a_compass_has_observed_are_left_to_it():
    assert gains(0.05, compass=True) == pytest.approx(1.0)


def land(state, residual, *, times, swing_speed_mps=4.0):
    """So many landings after swings of 3 rad, each off by ``residual`` for a radian."""
    ring, step = new_ring(200.0), np.zeros(1, STEP)[0]
    for _ in range(times):
        state["swing_rad"], state["swing_speed_mps"] = 3.0, swing_speed_mps
        state["velocity_n_mps"] = (3.0 * residual, 0.0, 0.0)
        state["covariance"][VELOCITY + 2, VELOCITY + 2] = 1e-4
        on_footfall(ring, step, state, 0, CONFIG)


@pytest.mark.slow
def test_gains_that_landings_have_shown_are_reported_after_the_filter_has_adapted():
    """The accelerometer's bias takes up what gains do to alike strides; the gains remain."""
    state = new_filter_state()[0]
    state["rotation_nb"] = np.eye(3)
    land(state, 0.03, times=60)
    shown = reported_gain_inflation(state, CONFIG)
    assert shown > 0.8
    land(state, 0.008, times=300)
    assert scale_error_inflation(state, CONFIG) < 0.1
    assert reported_gain_inflation(state, CONFIG) == shown


@pytest.mark.slow
def test_gains_are_as_early_landings_show_them_until_enough_of_them_have_been_seen():
    state = new_filter_state()[0]
    state["rotation_nb"] = np.eye(3)
    land(state, 0.03, times=15)
    louder = reported_gain_inflation(state, CONFIG)
    land(state, 0.01, times=20)
    assert reported_gain_inflation(state, CONFIG) < louder


def started():
    """A state as it is before any landing, of a sensor that nobody has described."""
    state = new_filter_state()[0]
    state["rotation_nb"] = np.eye(3)
    usual = CONFIG["residuals"]["mean_zupt_residual"]
    state["mean_gain_residual"] = state["gain_residual"] = usual
    return state


@pytest.mark.slow
def test_gains_that_no_landing_has_shown_are_those_of_a_data_sheet():
    """Swings of a crawl are too slow to show them, and their landings are no evidence."""
    state = started()
    land(state, 0.01, times=60, swing_speed_mps=1.5)
    assert reported_gain_inflation(state, CONFIG) == pytest.approx(1.0)
    land(state, 0.01, times=3)
    assert 0.5 < reported_gain_inflation(state, CONFIG) < 0.8
    land(state, 0.01, times=60)
    assert reported_gain_inflation(state, CONFIG) < 0.2


@pytest.mark.slow
def test_landings_of_a_sprint_show_gains_that_are_worse_than_a_data_sheet():
    """The effect of the gains grows with the speed: the bound is for what is left of it."""
    state = started()
    land(state, 0.09, times=60, swing_speed_mps=15.0)
    assert reported_gain_inflation(state, CONFIG) > 1.0
