"""Fixed-lag smoother: a stance corrects the swing before it.

The modified Bryson-Frazier form (Bierman 1973) carries one vector and one matrix backward instead
of inverting covariances: with ``l`` the adjoint error and ``L`` its information, a row becomes ``x
- P l`` with covariance ``P - P L P``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    HEADING,
    LEVER,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.foot.state import Step, Trail
from edge.tracker.mechanization.strapdown import rotate_navigation
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def smooth(ring: Ring, trail: Trail, first: int, stop: int, last: int) -> None:
    """Correct the rows ``first`` to ``stop - 1`` by everything measured up to ``last``."""
    adjoint = np.zeros(SIZE)
    for k in range(last, first - 1, -1):
        slot = k & (len(ring) - 1)
        step = trail[k & (len(trail) - 1)]
        if k < stop:
            _correct_row(ring, step, slot, adjoint)
        _back_over_updates(step, adjoint)
        _back_over_interval(step, ring[slot].interval_s, adjoint)


@njit()
def _correct_row(ring: Ring, step: Step, slot: int, adjoint: Floats) -> None:
    covariance = step.covariance
    for i in range(3):
        position = 0.0
        velocity = 0.0
        for j in range(SIZE):
            position += covariance[i, j] * adjoint[j]
            velocity += covariance[3 + i, j] * adjoint[j]
        ring[slot].position_n_m[i] -= position
        ring[slot].velocity_n_mps[i] -= velocity
    x = 0.0
    y = 0.0
    z = 0.0
    for j in range(SIZE):
        x -= covariance[6, j] * adjoint[j]
        y -= covariance[7, j] * adjoint[j]
        z -= (covariance[8, j] + covariance[TURN, j]) * adjoint[j]
    rotate_navigation(ring[slot].quaternion_nb, x, y, z)


@njit()
def _back_over_updates(step: Step, adjoint: Floats) -> None:
    for u in range(step.updates - 1, -1, -1):
        gain = step.update_gain[u]
        pull = step.update_pull[u]
        for j in range(SIZE):
            pull += gain[j] * adjoint[j]
        index = step.update_index[u]
        if index == HEADING:
            adjoint[ATTITUDE + 2] -= pull
            adjoint[TURN] -= pull
            continue
        adjoint[index] -= pull
        if VELOCITY <= index < VELOCITY + 3:
            for j in range(3):
                adjoint[LEVER + j] += step.lever_row[index - VELOCITY, j] * pull


@njit()
def _back_over_interval(step: Step, dt_s: float, adjoint: Floats) -> None:
    """Multiply by the transposed transition (error_model.transition_matrix)."""
    for i in range(3):
        adjoint[GYRO_BIAS_PER_K + i] += step.bias_step_k * adjoint[GYRO_BIAS + i]
    if dt_s < 0.0:  # across a gap velocity and tilt do not carry over
        for i in range(VELOCITY, ATTITUDE + 2):
            adjoint[i] = 0.0
        return
    fx = dt_s * step.force_n_mps2[0]
    fy = dt_s * step.force_n_mps2[1]
    fz = dt_s * step.force_n_mps2[2]
    rotation = step.rotation_nb
    vx, vy, vz = adjoint[3], adjoint[4], adjoint[5]
    ax, ay, az = adjoint[6], adjoint[7], adjoint[8]
    for i in range(3):
        adjoint[3 + i] += dt_s * adjoint[i]
        x, y, z = dt_s * rotation[0, i], dt_s * rotation[1, i], dt_s * rotation[2, i]
        adjoint[GYRO_BIAS + i] -= x * ax + y * ay + z * az
        adjoint[ACCEL_BIAS + i] -= x * vx + y * vy + z * vz
    adjoint[6] += fy * vz - fz * vy
    adjoint[7] += fz * vx - fx * vz
    adjoint[8] += fx * vy - fy * vx
