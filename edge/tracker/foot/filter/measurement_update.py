"""Measurement updates at one instant, one scalar after the other, recorded for the smoother.

``begin_updates``, any number of measurements, ``end_updates``: residuals are measured minus
predicted for the state as it was at the beginning.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    HEADING,
    LEVER,
    POSITION,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.foot.filter.bridge_scale import correct_bridges, update_bridges
from edge.tracker.foot.filter.correction_tracking import apply_clone_correction, update_clone
from edge.tracker.foot.filter.error_model import update_heading, update_one, update_velocity
from edge.tracker.foot.filter.scale_misalignment import update_scale_errors
from edge.tracker.foot.state import FilterState, Step
from edge.tracker.mechanization.strapdown import rotate_navigation, rotation_matrix


@njit()
def begin_updates(state: FilterState) -> None:
    for i in range(SIZE):
        state.error[i] = 0.0


@njit()
def measure(step: Step, state: FilterState, index: int, residual: float, variance: float) -> None:
    """Use one scalar measurement of error ``index``."""
    innovation, weight = update_one(
        state.covariance,
        state.error,
        index,
        residual,
        variance,
        state.column,
        step.update_gain[step.updates],
    )
    _note(step, state, index, innovation, weight)


@njit()
def measure_heading(step: Step, state: FilterState, residual_rad: float, variance: float) -> None:
    """Use a measurement of the heading, clockwise seen from above."""
    innovation, weight = update_heading(
        state.covariance,
        state.error,
        residual_rad,
        variance,
        state.column,
        step.update_gain[step.updates],
    )
    _note(step, state, HEADING, innovation, weight)


@njit()
def measure_velocity(
    step: Step, state: FilterState, residual_mps: Floats, variance: float
) -> float:
    """Use the sensor's velocity (3,) beyond what ``step.lever_row`` and the lever tell.

    Returns the sum of the innovations squared by their variances.
    """
    weight = state.angle_rad  # as scratch
    update_velocity(
        state, step.lever_row, residual_mps, variance, step.update_gain[step.updates :], weight
    )
    nis = 0.0
    for axis in range(3):
        _note(step, state, VELOCITY + axis, residual_mps[axis], weight[axis])
        nis += residual_mps[axis] * residual_mps[axis] * weight[axis]
    return nis


@njit()
def _note(step: Step, state: FilterState, index: int, innovation: float, weight: float) -> None:
    pull = innovation * weight
    update_clone(state, step, index, pull)
    update_bridges(state, weight)
    remember(step, index, pull)


@njit()
def remember(step: Step, index: int, pull: float) -> None:
    """Count the update whose gain is in ``step``, for the smoother."""
    u = step.updates
    step.update_index[u] = index
    step.update_pull[u] = pull
    step.updates = u + 1


@njit()
def end_updates(state: FilterState) -> None:
    """Move the gathered error into the state."""
    error = state.error
    correct_bridges(state)
    apply_clone_correction(state)
    for i in range(3):
        state.position_n_m[i] += error[POSITION + i]
        state.velocity_n_mps[i] += error[VELOCITY + i]
        state.gyro_bias_radps[i] += error[GYRO_BIAS + i]
        state.accel_bias_mps2[i] += error[ACCEL_BIAS + i]
        state.lever_b_m[i] += error[LEVER + i]
        state.gyro_bias_per_k[i] += error[GYRO_BIAS_PER_K + i]
    rotate_navigation(
        state.quaternion_nb, error[ATTITUDE], error[ATTITUDE + 1], error[ATTITUDE + 2]
    )
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    if error[TURN] != 0.0:
        update_scale_errors(state)
        rotate_state(state, error[TURN])


@njit()
def rotate_state(state: FilterState, angle_rad: float) -> None:
    """Turn where the walk is heading by a small angle about the vertical."""
    if angle_rad == 0.0:
        return
    north_mps = state.velocity_n_mps[0]
    state.velocity_n_mps[0] -= angle_rad * state.velocity_n_mps[1]
    state.velocity_n_mps[1] += angle_rad * north_mps
    rotate_navigation(state.quaternion_nb, 0.0, 0.0, angle_rad)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
