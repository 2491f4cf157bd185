"""Scales of bridged rates: the same as in a filter that has them among its states."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import ATTITUDE, SIZE, TURN, VELOCITY
from edge.tracker.foot.filter.bridge_scale import propagate_bridge, start_bridges
from edge.tracker.foot.filter.measurement_update import begin_updates, end_updates, measure
from edge.tracker.foot.state import BRIDGES, CLONES, STEP, new_filter_state

AXIS, BRIDGED_RAD = 1, -0.2
SCALE = SIZE + 2 * AXIS + 1  # in a state of all 28


def a_state():
    """Return a filter state whose scales are tied to its errors, and the covariance (28, 28)."""
    rng = np.random.default_rng(1)
    root = 0.1 * rng.normal(size=(SIZE + BRIDGES, SIZE + BRIDGES))
    root[TURN] = 0.0  # tied to nothing but by a compass
    whole = root @ root.T
    state = new_filter_state()[0]
    state["rotation_nb"] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    state["covariance"] = whole[:SIZE, :SIZE]
    state["clone"]["rows"] = CLONES + BRIDGES
    state["clone"]["covariance"][CLONES:] = whole[SIZE:, :SIZE]
    state["bridge"]["covariance"] = whole[SIZE:, SIZE:]
    return state, whole


def whole_of(state):
    cross = state["clone"]["covariance"][CLONES:]
    return np.block([[state["covariance"], cross.T], [cross, state["bridge"]["covariance"]]])


def test_a_bridged_angle_ties_attitude_and_scale_as_one_filter_of_all_errors_does():
    state, whole = a_state()
    transition = np.eye(SIZE + BRIDGES)
    transition[ATTITUDE : ATTITUDE + 3, SCALE] = BRIDGED_RAD * state["rotation_nb"][:, AXIS]
    propagate_bridge(state, AXIS, BRIDGED_RAD)
    assert whole_of(state) == pytest.approx(transition @ whole @ transition.T)


def test_a_measurement_of_an_error_corrects_the_scales_by_their_covariance_with_it():
    state, whole = a_state()
    state["bridge"]["scale"] = 1.0
    variance, residual = 0.05, 0.3
    step = np.zeros(1, STEP)[0]
    begin_updates(state)
    measure(step, state, VELOCITY, residual, variance)
    end_updates(state)
    gain = whole[:, VELOCITY] / (whole[VELOCITY, VELOCITY] + variance)
    assert state["bridge"]["scale"] == pytest.approx(1.0 + gain[SIZE:] * residual)
    assert whole_of(state) == pytest.approx(whole - np.outer(gain, whole[VELOCITY]))


def test_nothing_is_bridged_before_a_rate_clips():
    state = new_filter_state()[0]
    start_bridges(state, config_record(EskfConfig())[0])
    propagate_bridge(state, AXIS, 0.0)
    assert state["clone"]["rows"] == CLONES
    assert not state["covariance"].any()
    propagate_bridge(state, AXIS, BRIDGED_RAD)
    std = EskfConfig().clipping.bridge_scale_std
    assert state["covariance"][ATTITUDE + AXIS, ATTITUDE + AXIS] == pytest.approx(
        (std * BRIDGED_RAD) ** 2
    )
