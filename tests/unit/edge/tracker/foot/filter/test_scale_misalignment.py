"""Effect of the gyroscope's gain errors on heading and position, against real gain errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import SIZE, TURN
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.foot.filter.error_model import heading_variance
from edge.tracker.foot.filter.measurement_update import begin_updates, end_updates, measure_heading
from edge.tracker.foot.filter.scale_misalignment import project, propagate_scale_errors
from edge.tracker.foot.state import SCALE_ERRORS, STEP, new_filter_state
from edge.tracker.mechanization.strapdown import rotate_attitude, rotation_matrix
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import walk

CONFIG = EskfConfig()
GAIN_STD = 0.01
DT_S = 0.005
FORCE_MPS2 = np.array([0.0, 0.0, -9.8])


def ramble(seconds=8.0, gain=None, per_force=None):
    """Heading, position and filter state of a sensor that turns and moves anyhow.

    ``gain`` and ``per_force`` (3, 3) are what its gyroscope really adds to the rate.
    """
    state = new_filter_state()[0]
    state["scale_errors"]["std"] = GAIN_STD
    state["scale_errors"]["down_b"] = [0.0, 0.0, 1.0]
    state["rest_force_mps2"] = FORCE_MPS2
    quaternion, rotation = np.array([1.0, 0.0, 0.0, 0.0]), np.eye(3)
    turned_rad, position_m = 0.0, np.zeros(2)
    for t_s in np.arange(0.0, seconds, DT_S):
        rate = np.array([np.sin(3 * t_s), 2.0 * np.cos(2 * t_s), 0.7])
        force = FORCE_MPS2 + np.array([3.0 * np.sin(2 * t_s), 1.0, 2.0 * np.cos(3 * t_s)])
        speed = np.array([1.0 + 0.3 * t_s, np.sin(t_s), 0.0])
        middle = quaternion.copy()
        rotate_attitude(middle, 0.5 * DT_S * rate)
        rotation_matrix(middle, rotation)
        if gain is not None:
            turned_rad += DT_S * rotation[2] @ (gain @ rate + per_force @ (force - FORCE_MPS2))
        rotate_attitude(quaternion, DT_S * rate)
        rotation_matrix(quaternion, state["rotation_nb"])
        state["gyro_radps"], state["accel_mps2"], state["velocity_n_mps"] = rate, force, speed
        propagate_scale_errors(state, DT_S, CONFIG)
        position_m += DT_S * (speed[:2] + turned_rad * np.array([-speed[1], speed[0]]))
    return turned_rad, position_m, state


@pytest.mark.slow
def test_each_error_turns_the_walk_by_what_is_stated_of_it():
    _, straight_m, state = ramble()
    noise = np.random.default_rng(4)
    gain, per_force = noise.normal(0.0, 1e-3, (2, 3, 3))
    turned_rad, position_m, _ = ramble(gain=gain, per_force=per_force)
    errors = np.concatenate(
        (gain.ravel() / GAIN_STD, per_force.ravel() / (GAIN_STD * CONFIG.start.gain_per_force))
    )
    assert abs(turned_rad) > 1e-3
    # Row i of the matrices is counted by how far axis i points down.
    assert state["scale_errors"]["heading_sensitivity"] @ errors == pytest.approx(
        turned_rad, rel=2e-3
    )
    np.testing.assert_allclose(
        state["scale_errors"]["position_sensitivity"] @ errors,
        position_m - straight_m,
        rtol=1e-2,
        atol=1e-4,
    )
    variance = np.sum(state["scale_errors"]["heading_sensitivity"] ** 2)
    assert heading_variance(state["covariance"]) == pytest.approx(variance)


def received(residual_rad, variance):
    """The state after a compass told of the heading, and as it was before."""
    _, _, state = ramble()
    before = state.copy()
    step = np.zeros(1, STEP)[0]
    begin_updates(state)
    measure_heading(step, state, residual_rad, variance)
    end_updates(state)
    return before, state


@pytest.mark.slow
def test_a_compass_tells_of_the_gains_as_a_kalman_filter_would():
    before, after = received(0.02, 1e-4)
    turned = before["scale_errors"]["heading_sensitivity"]
    total = turned @ turned + 1e-4
    gain = turned / total
    np.testing.assert_allclose(after["scale_errors"]["estimate"], 0.02 * gain)
    np.testing.assert_allclose(
        after["scale_errors"]["covariance"],
        np.eye(SCALE_ERRORS) - np.outer(gain, turned),
        atol=1e-12,
    )
    moved_m = before["scale_errors"]["position_sensitivity"] @ (0.02 * gain)
    np.testing.assert_allclose(after["position_n_m"][:2] - before["position_n_m"][:2], moved_m)
    assert heading_variance(after["covariance"]) == pytest.approx(turned @ turned * 1e-4 / total)
    off_diagonal = np.delete(after["covariance"][TURN], TURN)
    assert len(off_diagonal) == SIZE - 1
    assert not off_diagonal.any()


def test_estimate_by_a_compass_continues_to_correct_the_walk():
    _, state = received(0.02, 1e-6)
    state["gyro_radps"], state["accel_mps2"] = [0.0, 0.0, 1.0], FORCE_MPS2
    before = state["scale_errors"]["heading_sensitivity"].copy()
    known_rad = propagate_scale_errors(state, DT_S, CONFIG)
    added = state["scale_errors"]["heading_sensitivity"] - before
    assert known_rad == pytest.approx(added @ state["scale_errors"]["estimate"])
    assert known_rad != 0.0
    column = np.zeros(SCALE_ERRORS)
    project(state["scale_errors"], added, column)
    assert added @ column < added @ added
    scale_errors = state["scale_errors"]
    np.testing.assert_allclose(
        scale_errors["position_column"],
        scale_errors["position_sensitivity"] @ scale_errors["covariance"],
        atol=1e-12,
    )


def stated(description, imu):
    """Standard deviation of the last position and of its heading."""
    tracker = EskfTracker(description)
    rows = join_rows([tracker.push(imu), tracker.finish()])
    return np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2])), rows.heading_std_rad[-1]


def test_a_calibrated_sensor_is_stated_surer():
    made = walk(strides=30)
    poor_m, poor_rad = stated(made.description, made.imu)
    # Landings as quiet as these show an undescribed sensor to be as good as 0.002, and no better.
    good_m, good_rad = stated(replace(made.description, gain_std=0.001), made.imu)
    assert good_m < 0.6 * poor_m
    assert good_rad < poor_rad
