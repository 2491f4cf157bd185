"""Which noise is an ordinary stride's, and so stated as the landings show it."""

from __future__ import annotations

import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import ATTITUDE, POSITION
from edge.tracker.foot.state import new_filter_state
from edge.tracker.foot.zupt.zupt_residuals import on_lift_off

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


def test_what_a_fault_adds_is_not():
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
