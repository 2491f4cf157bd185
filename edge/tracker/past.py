"""What a correction does to where the foot has been, and not to where it goes.

What the filter learns puts right heading and position by all that was wrong since the start.  At
every stance that is a little, the more the farther the start is; metres, where a rest shows at last
what the gyroscope's bias did to somebody who started on the move (see ``first_rest``).  That is no
step.  Whoever follows the walk step by step has to know which part of a move was none.

So the filter keeps what the position and the heading of a moment ago, when rows were last released
while the foot stood, have to do with the error state (stochastic cloning: Roumeliotis and Burdick
2002, "Stochastic cloning: a generalized framework for processing relative state measurements").
What an update moves them by is a correction of the past; the rest is the walk.

A heading that is put right by a little is the better one for the steps to come, so the walk takes
it over when the foot leaves the ground: what rests and a compass tell holds it for hours.  By more
than that at once it is put right where it had gone wrong fast, as before the bias is shown; those
who know by fixes where the walk has led never went by the wrong one, and the right one would turn
them.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.error_model import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_WARMTH,
    HEADING,
    LEVER,
    POSITION,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.state import FilterState, Step

YAW = ATTITUDE + 2
TAKEN_OVER_RAD = 0.01  # in one stance


@njit()
def hold_past(state: FilterState) -> None:
    """What is behind begins now."""
    past = state.past
    for j in range(SIZE):
        past.covariance[0, j] = state.covariance[POSITION, j]
        past.covariance[1, j] = state.covariance[POSITION + 1, j]
        past.covariance[2, j] = state.covariance[YAW, j]


@njit()
def carry_past(state: FilterState, dt_s: float) -> None:
    """An interval went by: the covariances of the past with the error state times ``F'``."""
    rotation_nb, force_n_mps2 = state.rotation_nb, state.force_n_mps2
    fx, fy, fz = dt_s * force_n_mps2[0], dt_s * force_n_mps2[1], dt_s * force_n_mps2[2]
    for i in range(3):
        row = state.past.covariance[i]
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
def tell_past(state: FilterState, step: Step, index: int, pull: float) -> None:
    """An update of error ``index``, whose gain is in ``step``, corrects the past too.

    ``pull`` is its innovation by its variance.
    """
    gain = step.update_gain[step.updates]
    for i in range(3):
        row = state.past.covariance[i]
        column = row[YAW] + row[TURN] if index == HEADING else row[index]
        if VELOCITY <= index < VELOCITY + 3:
            for j in range(3):
                column -= step.lever_row[index - VELOCITY, j] * row[LEVER + j]
        state.past.error[i] += column * pull
        for j in range(SIZE):
            row[j] -= column * gain[j]


@njit()
def correct_past(state: FilterState) -> None:
    """Count what the updates of one instant have gathered; a turn of the walk turns all of it."""
    past = state.past
    past.shift_n_m[0] += past.error[0]
    past.shift_n_m[1] += past.error[1]
    turn_rad = past.error[2] + state.error[TURN]
    past.turn_rad += turn_rad
    past.stance_turn_rad += turn_rad
    for i in range(3):
        past.error[i] = 0.0


@njit()
def take_over(state: FilterState) -> None:
    """Have the walk follow what this stance, which is over, has put right of the heading."""
    past = state.past
    if state.bias_shown and abs(past.stance_turn_rad) < TAKEN_OVER_RAD:
        past.turn_rad -= past.stance_turn_rad
    past.stance_turn_rad = 0.0


@njit()
def widen_past(state: FilterState, direction: Floats, by: float) -> None:
    """The bias is widened along ``direction`` (3,), and all with it that it has moved.

    ``by`` over a covariance with it; ``state.column`` is that of the error state.
    """
    for i in range(3):
        row = state.past.covariance[i]
        with_bias = 0.0
        for j in range(3):
            with_bias += row[GYRO_BIAS + j] * direction[j]
        for j in range(SIZE):
            row[j] += by * with_bias * state.column[j]


@njit()
def warm_past(state: FilterState, step_k: float) -> None:
    """As ``error_model.warm``."""
    for i in range(3):
        row = state.past.covariance[i]
        for j in range(3):
            row[GYRO_BIAS + j] += step_k * row[GYRO_WARMTH + j]


@njit()
def forget_with_past(state: FilterState, index: int, kept: float) -> None:
    """Of what an error has to do with the past this share is left."""
    for i in range(3):
        state.past.covariance[i, index] *= kept
