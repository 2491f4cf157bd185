"""The error state: how errors grow from sample to sample and shrink with a measurement.

Errors are true minus estimated, in this order: position (m, NED), velocity (m/s, NED),
attitude (rad, small rotation in NED axes: ``R_true = (1 + [a x]) R``), turn (rad), gyroscope
bias (rad/s, sensor axes), accelerometer bias (m/s^2, sensor axes), lever (m, sensor axes)
from the point about which the foot rolls in stance to the sensor, drift (rad for each unit
of excursion), and what
a kelvin adds to the gyroscope bias (rad/s/K, sensor axes), turn scale.

The turn is the part of the heading's error that has turned the whole walk with it.  It grows
by the drift times the foot's excursion: what scale, misalignment and sensitivity to force
leave of a stride is as systematic as the stride, and without it the stated heading would
grow like the root of the time instead of the time.  It also grows by the turn's scale (rad
for each rad) where the foot turns about the vertical, for good: ten times around in a
stairwell.  A walk turned as a whole looks the same to every stance, so the turn enters the
position alone and only a compass can tell it.
Formulas: Sola, "Quaternion kinematics for the error-state Kalman filter", 2017,
chapter 7 (global angular error).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats

POSITION = 0
VELOCITY = 3
ATTITUDE = 6
TURN = 9
GYRO_BIAS = 10
ACCEL_BIAS = 13
LEVER = 16
DRIFT = 19
GYRO_WARMTH = 20
TURN_SCALE = 23
SIZE = 24
HEADING = SIZE  # stands for what a compass measures: the sum of ATTITUDE + 2 and TURN


def transition_matrix(
    rotation_nb: Floats,
    moved_n_m: Floats,
    force_n_mps2: Floats,
    excursion: float,
    yawed_rad: float,
    dt_s: float,
) -> Floats:
    """Return the dense transition (24, 24) of one interval; ``propagate`` applies the same.

    ``moved_n_m`` (2,) is how far the foot moved, ``excursion`` its excursion (see filter),
    ``yawed_rad`` how far it turned clockwise seen from above.
    """
    x, y, z = force_n_mps2
    matrix = np.eye(SIZE)
    matrix[0:3, 3:6] = dt_s * np.eye(3)
    matrix[3:6, 6:9] = -dt_s * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix[3:6, 13:16] = -dt_s * rotation_nb
    matrix[6:9, 10:13] = -dt_s * rotation_nb
    matrix[0, TURN] = -moved_n_m[1]
    matrix[1, TURN] = moved_n_m[0]
    matrix[TURN, DRIFT] = excursion
    matrix[TURN, TURN_SCALE] = yawed_rad
    return matrix


@njit()
def propagate(
    covariance: Floats,
    rotation_nb: Floats,
    moved_n_m: Floats,
    force_n_mps2: Floats,
    excursion: float,
    yawed_rad: float,
    dt_s: float,
) -> None:
    """Replace ``covariance`` P (24, 24) by ``F P F'``, using what is zero and one in F."""
    fx = dt_s * force_n_mps2[0]
    fy = dt_s * force_n_mps2[1]
    fz = dt_s * force_n_mps2[2]
    north_m, east_m = moved_n_m[0], moved_n_m[1]
    p = covariance
    r = dt_s * rotation_nb
    # Rows: M = F P, top down so that every row reads rows not yet changed.
    for j in range(SIZE):
        v0, v1, v2 = p[3, j], p[4, j], p[5, j]
        a0, a1, a2 = p[6, j], p[7, j], p[8, j]
        g0, g1, g2 = p[10, j], p[11, j], p[12, j]
        b0, b1, b2 = p[13, j], p[14, j], p[15, j]
        turn = p[TURN, j]
        p[0, j] += dt_s * v0 - east_m * turn
        p[1, j] += dt_s * v1 + north_m * turn
        p[2, j] += dt_s * v2
        p[3, j] = v0 + fz * a1 - fy * a2 - (r[0, 0] * b0 + r[0, 1] * b1 + r[0, 2] * b2)
        p[4, j] = v1 + fx * a2 - fz * a0 - (r[1, 0] * b0 + r[1, 1] * b1 + r[1, 2] * b2)
        p[5, j] = v2 + fy * a0 - fx * a1 - (r[2, 0] * b0 + r[2, 1] * b1 + r[2, 2] * b2)
        p[6, j] = a0 - (r[0, 0] * g0 + r[0, 1] * g1 + r[0, 2] * g2)
        p[7, j] = a1 - (r[1, 0] * g0 + r[1, 1] * g1 + r[1, 2] * g2)
        p[8, j] = a2 - (r[2, 0] * g0 + r[2, 1] * g1 + r[2, 2] * g2)
        p[TURN, j] = turn + excursion * p[DRIFT, j] + yawed_rad * p[TURN_SCALE, j]
    # Columns: P = M F'; the lower triangle is the mirror.
    for i in range(TURN + 1):
        row = p[i]
        v0, v1, v2 = row[3], row[4], row[5]
        a0, a1, a2 = row[6], row[7], row[8]
        g0, g1, g2 = row[10], row[11], row[12]
        b0, b1, b2 = row[13], row[14], row[15]
        turn = row[TURN]
        row[0] += dt_s * v0 - east_m * turn
        row[1] += dt_s * v1 + north_m * turn
        row[2] += dt_s * v2
        row[3] = v0 + fz * a1 - fy * a2 - (r[0, 0] * b0 + r[0, 1] * b1 + r[0, 2] * b2)
        row[4] = v1 + fx * a2 - fz * a0 - (r[1, 0] * b0 + r[1, 1] * b1 + r[1, 2] * b2)
        row[5] = v2 + fy * a0 - fx * a1 - (r[2, 0] * b0 + r[2, 1] * b1 + r[2, 2] * b2)
        row[6] = a0 - (r[0, 0] * g0 + r[0, 1] * g1 + r[0, 2] * g2)
        row[7] = a1 - (r[1, 0] * g0 + r[1, 1] * g1 + r[1, 2] * g2)
        row[8] = a2 - (r[2, 0] * g0 + r[2, 1] * g1 + r[2, 2] * g2)
        row[TURN] = turn + excursion * row[DRIFT] + yawed_rad * row[TURN_SCALE]
    for i in range(TURN + 1):
        for j in range(i + 1, SIZE):
            p[j, i] = p[i, j]


@njit()
def warm(covariance: Floats, step_k: float) -> None:
    """Replace ``covariance`` by what it is after the sensor warmed by ``step_k`` kelvin."""
    p = covariance
    for i in range(3):
        for j in range(SIZE):
            p[GYRO_BIAS + i, j] += step_k * p[GYRO_WARMTH + i, j]
    for j in range(SIZE):
        for i in range(3):
            p[j, GYRO_BIAS + i] += step_k * p[j, GYRO_WARMTH + i]


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
    instant's updates; ``error`` (24,) gathers the correction.  ``gain`` (24,)
    leaves as the Kalman gain; ``column`` (24,) is scratch.  Returns the innovation
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
def update_with_lever(
    covariance: Floats,
    error: Floats,
    index: int,
    lever_row: Floats,
    residual: float,
    variance: float,
    column: Floats,
    gain: Floats,
) -> tuple[float, float]:
    """Use one scalar measurement of error ``index`` minus ``lever_row`` (3,) times the lever's."""
    a, b, c = lever_row[0], lever_row[1], lever_row[2]
    for i in range(SIZE):
        row = covariance[i]
        column[i] = row[index] - a * row[LEVER] - b * row[LEVER + 1] - c * row[LEVER + 2]
    innovation = residual - error[index]
    innovation += a * error[LEVER] + b * error[LEVER + 1] + c * error[LEVER + 2]
    measured = column[index] - a * column[LEVER] - b * column[LEVER + 1] - c * column[LEVER + 2]
    weight = 1.0 / (measured + variance)
    _apply(covariance, error, column, innovation, weight, gain)
    return innovation, weight


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
