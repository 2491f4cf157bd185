"""The filter's linear model against finite differences of what it linearises."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    LEVER,
    POSITION,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.foot.filter.error_model import (
    heading_variance,
    propagate,
    propagate_temperature,
    transition_matrix,
    update_heading,
    update_one,
    update_velocity,
)
from edge.tracker.foot.state import new_filter_state
from edge.tracker.foot.zupt.zupt import lever_velocity_row
from edge.tracker.mechanization.strapdown import (
    GRAVITY_MPS2,
    advance,
    rotate_attitude,
    rotate_navigation,
    rotation_matrix,
)

Floats = NDArray[np.float64]
Interval = tuple[Floats, Floats]  # what a transition is made of

DT_S = 1e-3
STEP = 1e-6


def _random_state(seed):
    noise = np.random.default_rng(seed)
    quaternion = noise.standard_normal(4)
    return {
        "position": noise.standard_normal(3),
        "velocity": noise.standard_normal(3),
        "quaternion": quaternion / np.linalg.norm(quaternion),
        "gyro_bias": 0.1 * noise.standard_normal(3),
        "accel_bias": 0.1 * noise.standard_normal(3),
        "accel": 20.0 * noise.standard_normal(3),
        "gyro": 3.0 * noise.standard_normal(3),
    }


def _perturbed(state, error):
    quaternion = state["quaternion"].copy()
    rotate_navigation(quaternion, *error[ATTITUDE : ATTITUDE + 3])
    return state | {
        "position": state["position"] + error[POSITION : POSITION + 3],
        "velocity": state["velocity"] + error[VELOCITY : VELOCITY + 3],
        "quaternion": quaternion,
        "gyro_bias": state["gyro_bias"] + error[GYRO_BIAS : GYRO_BIAS + 3],
        "accel_bias": state["accel_bias"] + error[ACCEL_BIAS : ACCEL_BIAS + 3],
    }


def _advanced(state: dict[str, Any]) -> tuple[Floats, Floats, Floats, Interval]:
    position, velocity = state["position"].copy(), state["velocity"].copy()
    quaternion, rotation, force = state["quaternion"].copy(), np.eye(3), np.zeros(3)
    accel, gyro = state["accel"] - state["accel_bias"], state["gyro"] - state["gyro_bias"]
    advance(
        position, velocity, quaternion, rotation, accel, gyro, GRAVITY_MPS2, DT_S, force,
        np.zeros(3),
    )  # fmt: skip
    return position, velocity, quaternion, (rotation, force)


def _attitude_error(quaternion_true, quaternion):
    true, estimated = np.zeros((3, 3)), np.zeros((3, 3))
    rotation_matrix(quaternion_true, true)
    rotation_matrix(quaternion, estimated)
    turn = true @ estimated.T
    return 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_transition_is_the_derivative_of_the_strapdown_step(seed):
    state = _random_state(seed)
    position, velocity, quaternion, interval = _advanced(state)
    numeric = np.zeros((SIZE, SIZE))
    for column in range(SIZE):
        error = np.zeros(SIZE)
        error[column] = STEP
        p, v, q, _ = _advanced(_perturbed(state, error))
        numeric[POSITION : POSITION + 3, column] = (p - position) / STEP
        numeric[VELOCITY : VELOCITY + 3, column] = (v - velocity) / STEP
        numeric[ATTITUDE : ATTITUDE + 3, column] = _attitude_error(q, quaternion) / STEP
        numeric[TURN:, column] = error[TURN:] / STEP
    # Terms of second order in the interval are left out on purpose.
    np.testing.assert_allclose(transition_matrix(*interval, DT_S), numeric, atol=2e-5)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_sparse_propagation_is_the_dense_product(seed):
    noise = np.random.default_rng(seed)
    root = noise.standard_normal((SIZE, SIZE))
    covariance = root @ root.T
    state = _random_state(seed)
    *_, interval = _advanced(state)
    matrix = transition_matrix(*interval, 0.02)
    expected = matrix @ covariance @ matrix.T
    filtered = new_filter_state()[0]
    filtered["covariance"] = covariance
    filtered["rotation_nb"], filtered["force_n_mps2"] = interval
    propagate(filtered, 0.02)
    np.testing.assert_allclose(filtered["covariance"], expected, rtol=1e-12, atol=1e-12)
    assert np.array_equal(filtered["covariance"], filtered["covariance"].T)


def _joseph(before, row, variance):
    """Covariance and gain of a scalar measurement, for any gain that is used."""
    gain = before @ row / (row @ before @ row + variance)
    kept = np.eye(SIZE) - np.outer(gain, row)
    return kept @ before @ kept.T + variance * np.outer(gain, gain), gain


@pytest.mark.slow
@pytest.mark.parametrize("index", [POSITION, VELOCITY + 1, GYRO_BIAS + 2])
def test_scalar_update_is_the_joseph_form(index):
    noise = np.random.default_rng(index)
    root = noise.standard_normal((SIZE, SIZE))
    before = root @ root.T
    row = np.eye(SIZE)[index]
    variance = 0.3
    expected, gain = _joseph(before, row, variance)
    gathered = noise.standard_normal(SIZE)
    after, error = before.copy(), gathered.copy()
    column, found = np.zeros(SIZE), np.zeros(SIZE)
    innovation, weight = update_one(after, error, index, 2.0, variance, column, found)
    np.testing.assert_allclose(after, expected, atol=1e-9)
    np.testing.assert_allclose(error, gathered + gain * (2.0 - row @ gathered))
    np.testing.assert_allclose(found, gain)
    assert innovation == pytest.approx(2.0 - row @ gathered)
    assert weight == pytest.approx(1.0 / (row @ before @ row + variance))


@pytest.mark.slow
def test_velocity_update_is_three_scalar_ones():
    noise = np.random.default_rng(7)
    root = noise.standard_normal((SIZE, SIZE))
    lever_row, residual, variance = noise.standard_normal((3, 3)), np.array([2.0, -1.0, 0.5]), 0.3
    state = new_filter_state()[0]
    covariance = root @ root.T
    state["covariance"] = covariance
    error = noise.standard_normal(SIZE)
    state["error"] = error
    found, weight, innovation = np.zeros((3, SIZE)), np.zeros(3), residual.copy()
    update_velocity(state, lever_row, innovation, variance, found, weight)
    for axis in range(3):
        row = np.eye(SIZE)[VELOCITY + axis]
        row[LEVER : LEVER + 3] = -lever_row[axis]
        assert innovation[axis] == pytest.approx(residual[axis] - row @ error)
        assert weight[axis] == pytest.approx(1.0 / (row @ covariance @ row + variance))
        covariance, gain = _joseph(covariance, row, variance)
        np.testing.assert_allclose(found[axis], gain, atol=1e-9)
        error = error + gain * innovation[axis]
    np.testing.assert_allclose(state["error"], error, atol=1e-9)
    np.testing.assert_allclose(state["covariance"], covariance, atol=1e-9)
    assert np.array_equal(state["covariance"], state["covariance"].T)


def test_a_compass_measures_attitude_and_turn_together():
    noise = np.random.default_rng(5)
    root = noise.standard_normal((SIZE, SIZE))
    before = root @ root.T
    row = np.zeros(SIZE)
    row[[ATTITUDE + 2, TURN]] = 1.0
    assert heading_variance(before) == pytest.approx(row @ before @ row)
    gain = before @ row / (row @ before @ row + 0.3)
    after, error, found = before.copy(), np.zeros(SIZE), np.zeros(SIZE)
    update_heading(after, error, 0.2, 0.3, np.zeros(SIZE), found)
    np.testing.assert_allclose(found, gain)
    np.testing.assert_allclose(error, 0.2 * gain)
    np.testing.assert_allclose(after, before - np.outer(gain, row @ before), atol=1e-9)


def test_warming_moves_the_bias_by_what_a_kelvin_adds():
    noise = np.random.default_rng(6)
    root = noise.standard_normal((SIZE, SIZE))
    covariance = root @ root.T
    matrix = np.eye(SIZE)
    matrix[GYRO_BIAS : GYRO_BIAS + 3, GYRO_BIAS_PER_K : GYRO_BIAS_PER_K + 3] = 0.7 * np.eye(3)
    expected = matrix @ covariance @ matrix.T
    propagate_temperature(covariance, 0.7)
    np.testing.assert_allclose(covariance, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("axis", range(3))
def test_stance_velocity_row_is_the_derivative_by_the_lever(axis):
    state = _random_state(axis)
    rotation, row = np.zeros((3, 3)), np.zeros(3)
    rotation_matrix(state["quaternion"], rotation)
    lever_velocity_row(rotation, state["gyro"], axis, row)
    for j, step in enumerate(STEP * np.eye(3)):
        moved = rotation @ np.cross(state["gyro"], step)
        assert row[j] == pytest.approx(moved[axis] / STEP)


def test_rotation_vector_turns_about_its_axis():
    quaternion = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(9):
        rotate_attitude(quaternion, np.radians([0.0, 0.0, 10.0]))
    matrix = np.zeros((3, 3))
    rotation_matrix(quaternion, matrix)
    np.testing.assert_allclose(matrix @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-12)
