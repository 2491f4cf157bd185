"""Fixed-lag smoothing: what a stance says about the swing before it.

The modified Bryson-Frazier form (Bierman 1973) carries one vector and one
matrix backward instead of inverting covariances: with ``l`` the adjoint error
and ``L`` its information, a row becomes ``x - P l`` with covariance
``P - P L P``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.error_model import LEVER, SIZE, VELOCITY
from edge.tracker.state import Ring
from edge.tracker.strapdown import rotate_navigation


@njit()
def smooth(ring: Ring, first: int, stop: int, last: int) -> None:
    """Correct the rows ``first`` to ``stop - 1`` by all that was measured up to ``last``."""
    mask = len(ring.t_ns) - 1
    adjoint = np.zeros(SIZE)
    for k in range(last, first - 1, -1):
        slot = k & mask
        if k < stop:
            _correct_row(ring, slot, adjoint)
        _back_over_updates(ring, slot, adjoint)
        _back_over_interval(ring, slot, adjoint)


@njit()
def _correct_row(ring: Ring, slot: int, adjoint: Floats) -> None:
    covariance = ring.covariance[slot]
    for i in range(3):
        position = 0.0
        velocity = 0.0
        for j in range(SIZE):
            position += covariance[i, j] * adjoint[j]
            velocity += covariance[3 + i, j] * adjoint[j]
        ring.position_n_m[slot, i] -= position
        ring.velocity_n_mps[slot, i] -= velocity
    x = 0.0
    y = 0.0
    z = 0.0
    for j in range(SIZE):
        x -= covariance[6, j] * adjoint[j]
        y -= covariance[7, j] * adjoint[j]
        z -= covariance[8, j] * adjoint[j]
    rotate_navigation(ring.quaternion_nb[slot], x, y, z)


@njit()
def _back_over_updates(ring: Ring, slot: int, adjoint: Floats) -> None:
    for u in range(ring.updates[slot] - 1, -1, -1):
        gain = ring.update_gain[slot, u]
        pull = ring.update_pull[slot, u]
        for j in range(SIZE):
            pull += gain[j] * adjoint[j]
        index = ring.update_index[slot, u]
        adjoint[index] -= pull
        if VELOCITY <= index < VELOCITY + 3:
            for j in range(3):
                adjoint[LEVER + j] += ring.lever_row[slot, index - VELOCITY, j] * pull


@njit()
def _back_over_interval(ring: Ring, slot: int, adjoint: Floats) -> None:
    """Multiply by the transposed transition (error_model.transition_matrix)."""
    dt_s = ring.interval_s[slot]
    if dt_s < 0.0:  # across a gap only position and biases carry over
        for i in range(3, 9):
            adjoint[i] = 0.0
        return
    fx = dt_s * ring.force_n_mps2[slot, 0]
    fy = dt_s * ring.force_n_mps2[slot, 1]
    fz = dt_s * ring.force_n_mps2[slot, 2]
    rotation = ring.rotation_nb[slot]
    vx, vy, vz = adjoint[3], adjoint[4], adjoint[5]
    ax, ay, az = adjoint[6], adjoint[7], adjoint[8]
    for i in range(3):
        adjoint[3 + i] += dt_s * adjoint[i]
        adjoint[9 + i] -= dt_s * (rotation[0, i] * ax + rotation[1, i] * ay + rotation[2, i] * az)
        adjoint[12 + i] -= dt_s * (rotation[0, i] * vx + rotation[1, i] * vy + rotation[2, i] * vz)
    adjoint[6] += fy * vz - fz * vy
    adjoint[7] += fz * vx - fx * vz
    adjoint[8] += fx * vy - fy * vx
