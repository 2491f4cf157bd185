"""Floors, stairs, kerbs and ramps, distinguished by the steps."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.foot.state import STEP, new_filter_state, new_progress
from edge.tracker.foot.zupt.level_walking import DOWN, apply_level_constraint
from edge.tracker.preprocessing.sample_ring import RING
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import walk


def risen_m(**how):
    made = walk(**how)
    tracker = EskfTracker(made.description)
    rows = join_rows([tracker.push(made.imu), tracker.finish()])
    return -rows.position_n_m[-1, 2], np.sqrt(rows.position_cov_m2[-1, 2, 2])


def test_a_flat_floor_stays_flat_with_a_sensor_that_drifts():
    risen, _ = risen_m(strides=40, accel_bias_mps2=(0.05, 0.0, -0.1))
    assert abs(risen) < 0.03


@pytest.mark.parametrize("rise_m", [-0.34, -0.17, 0.12, 0.17, 0.34])
def test_stairs_keep_their_height(rise_m):
    risen, std = risen_m(strides=20, stride_m=0.6, rise_m=rise_m)
    assert risen == pytest.approx(20 * rise_m, rel=0.03)
    assert abs(risen - 20 * rise_m) < 3.0 * std


@pytest.mark.parametrize("slope", [0.05, 0.083, -0.05])
def test_ramps_keep_their_height(slope):
    """From 5 % on; what the first strides of a gentle one lose is given back."""
    risen, _ = risen_m(strides=25, rise_m=slope * 1.3)
    assert risen == pytest.approx(25 * slope * 1.3, abs=0.12)
    short, _ = risen_m(strides=25, stride_m=0.9, rise_m=slope * 0.9)
    assert short == pytest.approx(25 * slope * 0.9, abs=0.12)


@pytest.mark.slow
def test_a_floor_is_no_better_known_than_when_it_was_entered():
    ring, step = np.zeros(8, RING), np.zeros(1, STEP)[0]
    ring["t_s"] = 10.0
    progress, state = new_progress()[0], new_filter_state()[0]
    progress["on_floor"] = True
    progress["level_variance_m2"] = progress["footfall_variance_m2"] = 0.04
    state["covariance"][DOWN, DOWN] = 0.0401
    apply_level_constraint(ring, step, progress, state, 0, config_record(EskfConfig())[0])
    assert state["covariance"][DOWN, DOWN] == 0.04


@pytest.mark.slow
def test_a_stair_does_not_give_back_what_was_the_habit_of_strides_on_the_flat():
    ring, step = np.zeros(8, RING), np.zeros(1, STEP)[0]
    ring["t_s"] = 10.0
    progress, state = new_progress()[0], new_filter_state()[0]
    progress["on_floor"] = True
    progress["withheld_m"] = 0.5
    state["position_n_m"][2] = -0.17
    apply_level_constraint(ring, step, progress, state, 0, config_record(EskfConfig())[0])
    assert state["position_n_m"][2] == -0.17
