"""Retrospective corrections by stochastic cloning: which part of a position change is no movement.

What the filter learns corrects heading and position for all errors since the start.  At every
stance that is a little, and more the farther the start is; it is metres where a rest shows at last
the gyroscope's bias of a walk that began on the move (see ``initial_gyro_bias``).  That is no step.
A consumer that follows the walk step by step has to know which part of a change was none.

So the filter keeps the covariance (3, 22) of position and heading of a moment ago, when rows were
last released while the foot stood, with the error state (Roumeliotis and Burdick 2002, "Stochastic
cloning: a generalized framework for processing relative state measurements").  What an update moves
them by is a retrospective correction; the rest is the walk.

A small correction of the heading is right for the steps to come too, so the walk accepts it when
the foot leaves the ground: rests and a compass hold it for hours.  A larger one at once corrects a
heading that had drifted fast, as before the bias is observed; consumers with GNSS fixes never
followed the wrong heading, and the correction would turn them.

The rows after these three belong to ``bridge_scale``, whose scales are tied to the error state in
the same way; they are in use once a rate has clipped.
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
from edge.tracker.foot.state import FilterState, Step

YAW = ATTITUDE + 2
ACCEPTED_TURN_RAD = 0.01  # in one stance


@njit()
def clone_reference(state: FilterState) -> None:
    """Clone position and heading as they are now."""
    clone = state.clone
    for j in range(SIZE):
        clone.covariance[0, j] = state.covariance[POSITION, j]
        clone.covariance[1, j] = state.covariance[POSITION + 1, j]
        clone.covariance[2, j] = state.covariance[YAW, j]


@njit()
def propagate_clone(state: FilterState, dt_s: float) -> None:
    """Propagate the clone's covariance with the error state over an interval: times ``F'``."""
    rotation_nb, force_n_mps2 = state.rotation_nb, state.force_n_mps2
    fx, fy, fz = dt_s * force_n_mps2[0], dt_s * force_n_mps2[1], dt_s * force_n_mps2[2]
    for i in range(state.clone.rows):
        row = state.clone.covariance[i]
        ax, ay, az = row[ATTITUDE], row[ATTITUDE + 1], row[ATTITUDE + 2]
        for axis in range(3):
            row[POSITION + axis] += dt_s * row[VELOCITY + axis]
        row[VELOCITY] += fz * ay - fy * az
        row[VELOCITY + 1] += fx * az - fz * ax
        row[VELOCITY + 2] += fy * ax - fx * ay
        for axis in range(3):
            for j in range(3):
                turned_s = dt_s * rotation_nb[axis, j]
                row[VELOCITY + axis] -= turned_s * row[ACCEL_BIAS + j]
                row[ATTITUDE + axis] -= turned_s * row[GYRO_BIAS + j]


@njit()
def update_clone(state: FilterState, step: Step, index: int, pull: float) -> None:
    """Correct the clone by an update of error ``index``, whose gain is in ``step``.

    ``pull`` is its innovation by its variance.
    """
    gain = step.update_gain[step.updates]
    for i in range(state.clone.rows):
        row = state.clone.covariance[i]
        column = row[YAW] + row[TURN] if index == HEADING else row[index]
        if VELOCITY <= index < VELOCITY + 3:
            for j in range(3):
                column -= step.lever_row[index - VELOCITY, j] * row[LEVER + j]
        state.clone.error[i] += column * pull
        state.clone.column[i] = column
        for j in range(SIZE):
            row[j] -= column * gain[j]


@njit()
def apply_clone_correction(state: FilterState) -> None:
    """Add what the updates of one instant have gathered; a turn of the walk turns all of it."""
    clone = state.clone
    clone.shift_n_m[0] += clone.error[0]
    clone.shift_n_m[1] += clone.error[1]
    turn_rad = clone.error[2] + state.error[TURN]
    clone.turn_rad += turn_rad
    clone.stance_turn_rad += turn_rad
    for i in range(3):
        clone.error[i] = 0.0


@njit()
def accept_heading(state: FilterState) -> None:
    """Let the walk follow what this stance, which is over, has corrected of the heading."""
    clone = state.clone
    if state.bias_observed and abs(clone.stance_turn_rad) < ACCEPTED_TURN_RAD:
        clone.turn_rad -= clone.stance_turn_rad
    clone.stance_turn_rad = 0.0


@njit()
def widen_clone(state: FilterState, direction: Floats, by: float) -> None:
    """Add variance of the bias along ``direction`` (3,), and of all that it has moved.

    ``by`` over a covariance with it; ``state.column`` is that of the error state.
    """
    for i in range(state.clone.rows):
        row = state.clone.covariance[i]
        with_bias = 0.0
        for j in range(3):
            with_bias += row[GYRO_BIAS + j] * direction[j]
        state.clone.column[i] = by * with_bias
        for j in range(SIZE):
            row[j] += by * with_bias * state.column[j]


@njit()
def warm_clone(state: FilterState, step_k: float) -> None:
    """Propagate a change of temperature, as ``error_model.propagate_temperature``."""
    for i in range(state.clone.rows):
        row = state.clone.covariance[i]
        for j in range(3):
            row[GYRO_BIAS + j] += step_k * row[GYRO_BIAS_PER_K + j]


@njit()
def decorrelate_clone(state: FilterState, index: int, kept: float) -> None:
    """Reduce the correlation of an error with the clone to the share ``kept``."""
    for i in range(state.clone.rows):
        state.clone.covariance[i, index] *= kept
