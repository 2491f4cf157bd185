"""Weight of a still sample."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import SIZE, VELOCITY
from edge.tracker.foot.state import STEP, new_filter_state, new_progress
from edge.tracker.foot.zupt.zupt import apply_zupt, is_gliding
from edge.tracker.preprocessing.sample_ring import RING, new_ring

CONFIG = config_record(EskfConfig())[0]
PERIOD_S = 0.005


def left_m2ps2(interval_s):
    """The variance of the velocity that a sample leaves, ``interval_s`` after the one before."""
    ring, step = np.zeros(8, RING), np.zeros(1, STEP)[0]
    ring["period_s"], ring["interval_s"], ring["motion_m2ps4"] = PERIOD_S, interval_s, 0.1
    state = new_filter_state()[0]
    state["covariance"][:] = np.eye(SIZE)
    apply_zupt(ring, step, state, 0, CONFIG)
    return float(state["covariance"][VELOCITY, VELOCITY])


@pytest.mark.slow
def test_a_still_sample_is_worth_the_time_since_the_one_before():
    assert left_m2ps2(2.0 * PERIOD_S) == pytest.approx(0.5 * left_m2ps2(PERIOD_S), rel=1e-2)


def test_after_a_hole_it_tells_of_its_own_moment():
    assert left_m2ps2(0.05) == pytest.approx(left_m2ps2(PERIOD_S), rel=1e-9)


def is_refused(since_s):
    """Return True if a sample that falls and lands soon after the last stance is refused."""
    ring, progress, state = new_ring(200.0), new_progress()[0], new_filter_state()[0]
    ring["t_s"] = np.arange(len(ring)) * PERIOD_S
    ring["motion_m2ps4"], ring["stride_minimum_m2ps4"] = 10.0, 10.0
    ring["motion_m2ps4"][10:] = 1e3  # by a force: nothing turns
    progress["measured"], progress["last_stance_s"] = 20, -since_s
    state["velocity_n_mps"][2] = 0.5
    state["covariance"][VELOCITY + 2, VELOCITY + 2] = 0.1**2
    return is_gliding(ring.view(np.recarray), progress, state, 0, CONFIG)


@pytest.mark.slow
def test_a_foot_that_falls_and_lands_soon_is_refused_for_one_stride_only():
    """Longer, and a wrong velocity would refuse every stance that could correct it."""
    assert is_refused(0.5)
    assert not is_refused(1.3)
