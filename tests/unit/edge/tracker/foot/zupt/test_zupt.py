"""Weight of a still sample."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import SIZE, VELOCITY
from edge.tracker.foot.state import STEP, new_filter_state
from edge.tracker.foot.zupt.zupt import apply_zupt
from edge.tracker.preprocessing.sample_ring import RING

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
