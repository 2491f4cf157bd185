"""Propagation of the error covariance from sample to sample, and scalar measurement updates.

The elements are those of ``error_state``.  Formulas: Sola, "Quaternion kinematics for the
error-state Kalman filter", 2017, chapter 7 (global angular error).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.foot.error_state import (
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    LEVER,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.foot.state import FilterState


def transition_matrix(rotation_nb: Floats, force_n_mps2: Floats, dt_s: float) -> Floats:
    """Return the dense transition (22, 22) of one interval; ``propagate`` applies the same."""
    x, y, z = force_n_mps2
    matrix = np.eye(SIZE)
    matrix[0:3, 3:6] = dt_s * np.eye(3)
    matrix[3:6, 6:9] = -dt_s * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix[3:6, 13:16] = -dt_s * rotation_nb
    matrix[6:9, 10:13] = -dt_s * rotation_nb
    return matrix


@njit()
def propagate(state: FilterState, dt_s: float) -> None:
    """Replace the covariance P by ``F P F'``, using what is zero and one in F.

    The record is taken whole, for its type gives the compiler the length of the rows of P, so
    that it can work on several columns at once.
    """
    p, rotation_nb, force_n_mps2 = state.covariance, state.rotation_nb, state.force_n_mps2
    fx = dt_s * force_n_mps2[0]
    fy = dt_s * force_n_mps2[1]
    fz = dt_s * force_n_mps2[2]
    r00, r01, r02 = dt_s * rotation_nb[0, 0], dt_s * rotation_nb[0, 1], dt_s * rotation_nb[0, 2]
    r10, r11, r12 = dt_s * rotation_nb[1, 0], dt_s * rotation_nb[1, 1], dt_s * rotation_nb[1, 2]
    r20, r21, r22 = dt_s * rotation_nb[2, 0], dt_s * rotation_nb[2, 1], dt_s * rotation_nb[2, 2]
    # Rows: M = F P, top down so that every row reads rows not yet changed.
    for j in range(SIZE):
        v0, v1, v2 = p[3, j], p[4, j], p[5, j]
        a0, a1, a2 = p[6, j], p[7, j], p[8, j]
        g0, g1, g2 = p[10, j], p[11, j], p[12, j]
        b0, b1, b2 = p[13, j], p[14, j], p[15, j]
        p[0, j] += dt_s * v0
        p[1, j] += dt_s * v1
        p[2, j] += dt_s * v2
        p[3, j] = v0 + fz * a1 - fy * a2 - (r00 * b0 + r01 * b1 + r02 * b2)
        p[4, j] = v1 + fx * a2 - fz * a0 - (r10 * b0 + r11 * b1 + r12 * b2)
        p[5, j] = v2 + fy * a0 - fx * a1 - (r20 * b0 + r21 * b1 + r22 * b2)
        p[6, j] = a0 - (r00 * g0 + r01 * g1 + r02 * g2)
        p[7, j] = a1 - (r10 * g0 + r11 * g1 + r12 * g2)
        p[8, j] = a2 - (r20 * g0 + r21 * g1 + r22 * g2)
    # Columns: P = M F' above the diagonal, left to right; the lower triangle is the mirror.
    for i in range(VELOCITY):
        row = p[i]
        row[0] += dt_s * row[3]
        row[1] += dt_s * row[4]
        row[2] += dt_s * row[5]
    for i in range(ATTITUDE):
        row = p[i]
        a0, a1, a2 = row[6], row[7], row[8]
        b0, b1, b2 = row[13], row[14], row[15]
        row[3] = row[3] + fz * a1 - fy * a2 - (r00 * b0 + r01 * b1 + r02 * b2)
        row[4] = row[4] + fx * a2 - fz * a0 - (r10 * b0 + r11 * b1 + r12 * b2)
        row[5] = row[5] + fy * a0 - fx * a1 - (r20 * b0 + r21 * b1 + r22 * b2)
    for i in range(TURN):
        row = p[i]
        g0, g1, g2 = row[10], row[11], row[12]
        row[6] -= r00 * g0 + r01 * g1 + r02 * g2
        row[7] -= r10 * g0 + r11 * g1 + r12 * g2
        row[8] -= r20 * g0 + r21 * g1 + r22 * g2
    for i in range(TURN):
        for j in range(i + 1, SIZE):
            p[j, i] = p[i, j]


@njit()
def propagate_temperature(covariance: Floats, step_k: float) -> None:
    """Replace ``covariance`` by what it is after the sensor warmed by ``step_k`` kelvin."""
    p = covariance
    for i in range(3):
        for j in range(SIZE):
            p[GYRO_BIAS + i, j] += step_k * p[GYRO_BIAS_PER_K + i, j]
    for j in range(SIZE):
        for i in range(3):
            p[j, GYRO_BIAS + i] += step_k * p[j, GYRO_BIAS_PER_K + i]


@njit()
def update_one(
    covariance: Floats,
    error: Floats,
    index: int,
    residual: float,
    variance: float,
    column: Floats,
    gain: Floats,
) -> tuple[float, float]:
    """Use one scalar measurement of error number ``index``.

    ``residual`` is measured minus predicted for the state before any of this
    instant's updates; ``error`` (22,) gathers the correction.  ``gain`` (22,)
    leaves as the Kalman gain; ``column`` (22,) is scratch.  Returns the innovation
    and its inverse variance.
    """
    for i in range(SIZE):
        column[i] = covariance[i, index]
    innovation = residual - error[index]
    weight = 1.0 / (column[index] + variance)
    _apply(covariance, error, column, innovation, weight, gain)
    return innovation, weight


@njit()
def update_heading(
    covariance: Floats,
    error: Floats,
    residual_rad: float,
    variance: float,
    column: Floats,
    gain: Floats,
) -> tuple[float, float]:
    """Use one measurement of the heading, as ``update_one`` does."""
    yaw = ATTITUDE + 2
    for i in range(SIZE):
        column[i] = covariance[i, yaw] + covariance[i, TURN]
    innovation = residual_rad - error[yaw] - error[TURN]
    weight = 1.0 / (column[yaw] + column[TURN] + variance)
    _apply(covariance, error, column, innovation, weight, gain)
    return innovation, weight


@njit()
def heading_variance(covariance: Floats) -> float:
    """Return the variance (rad^2) of the heading."""
    yaw = ATTITUDE + 2
    both = covariance[yaw, yaw] + covariance[TURN, TURN] + 2.0 * covariance[yaw, TURN]
    return float(max(both, 0.0))


@njit()
def update_velocity(
    state: FilterState,
    lever_row: Floats,
    residual_mps: Floats,
    variance: float,
    gain: Floats,
    weight: Floats,
) -> None:
    """Use a measurement of the velocity (3,) minus ``lever_row`` (3, 3) times the lever.

    It is that of three scalars, one after the other; the covariance, which must be symmetric, is
    touched once for all of them, and one half of it.  ``residual_mps`` (3,) leaves as the
    innovations, ``weight`` (3,) as their inverse variances; the rest is as in ``update_one``.
    """
    p, error, columns = state.covariance, state.error, state.velocity_column
    for axis in range(3):
        index, column, row = VELOCITY + axis, columns[axis], lever_row[axis]
        a, b, c = row[0], row[1], row[2]
        velocity, first, second, third = p[index], p[LEVER], p[LEVER + 1], p[LEVER + 2]
        for i in range(SIZE):
            column[i] = velocity[i] - a * first[i] - b * second[i] - c * third[i]
        for before in range(axis):
            taken = weight[before] * _beyond_lever(columns[before], index, row)
            for i in range(SIZE):
                column[i] -= taken * columns[before, i]
        residual_mps[axis] -= _beyond_lever(error, index, row)
        weight[axis] = 1.0 / (_beyond_lever(column, index, row) + variance)
        for i in range(SIZE):
            gain[axis, i] = column[i] * weight[axis]
            error[i] += gain[axis, i] * residual_mps[axis]
    for i in range(SIZE):
        c0, c1, c2 = columns[0, i], columns[1, i], columns[2, i]
        for j in range(i, SIZE):
            p[i, j] -= c0 * gain[0, j] + c1 * gain[1, j] + c2 * gain[2, j]
    for i in range(SIZE):
        for j in range(i + 1, SIZE):
            p[j, i] = p[i, j]


@njit()
def _beyond_lever(errors: Floats, index: int, lever_row: Floats) -> float:
    """Return element ``index`` of ``errors`` (22,) minus ``lever_row`` (3,) times the lever's."""
    lever = lever_row[0] * errors[LEVER]
    lever += lever_row[1] * errors[LEVER + 1] + lever_row[2] * errors[LEVER + 2]
    return float(errors[index] - lever)


@njit()
def _apply(
    covariance: Floats,
    error: Floats,
    column: Floats,
    innovation: float,
    weight: float,
    gain: Floats,
) -> None:
    for i in range(SIZE):
        gain[i] = column[i] * weight
        error[i] += gain[i] * innovation
    for i in range(SIZE):
        scaled = column[i]
        for j in range(SIZE):
            covariance[i, j] -= scaled * gain[j]
