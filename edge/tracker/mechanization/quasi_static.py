"""Orientation of a sensor at rest from gravity and the earth's magnetic field.

Huang 2009, section 3.5: the acceleration, low-passed at about 1 Hz by a filter of
linear phase, gives pitch and roll; the magnetic field, turned level by them, gives
the heading (equations 3.5 to 3.16).  Written with vectors instead of Euler angles,
which holds for any mount.  The filter's window ends where a swing begins: swings
within it would tilt the sensor by several degrees.  Without a magnetometer the heading
stays as tracked.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.mechanization.strapdown import rotate_navigation, rotation_matrix
from edge.tracker.preprocessing.sample_ring import Ring, reach, span

QUIET_RADPS = 0.6  # a sensor that turns faster swings


@njit()
def static_orientation(
    ring: Ring, count: int, k: int, low_pass_s: float, declination_rad: float, state: Any
) -> None:
    """Reset ``quaternion_nb`` and ``rotation_nb`` of ``state`` to the orientation at ``k``."""
    force_b = np.zeros(3)
    field_b = np.zeros(3)
    _low_pass(ring, count, k, low_pass_s, force_b, field_b)
    if force_b[0] != 0.0 or force_b[1] != 0.0 or force_b[2] != 0.0:
        turn_upright(state.quaternion_nb, force_b)
        rotation_matrix(state.quaternion_nb, state.rotation_nb)
        north = (state.rotation_nb[0] * field_b).sum()
        east = (state.rotation_nb[1] * field_b).sum()
        if north * north + east * east > 1.0:
            # Seen from the sensor, magnetic north lies where the level field points.
            turn_rad = declination_rad - math.atan2(east, north)
            turn_heading(state.quaternion_nb, turn_rad)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)


@njit()
def _low_pass(
    ring: Ring, count: int, k: int, low_pass_s: float, force_b: Floats, field_b: Floats
) -> None:
    """Add up force and field around ``k`` with the weights of a Hann window."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    half_s = 0.5 * low_pass_s
    first = k
    while first > 0 and k - first < span(ring):
        if now_s - ring[(first - 1) & mask].t_s >= half_s or _swings(ring, first - 1):
            break
        first -= 1
    weights = 0.0
    field_weights = 0.0
    for i in range(first, min(count, reach(ring, k))):
        sample = ring[i & mask]
        away_s = abs(sample.t_s - now_s)
        if away_s >= half_s or (i > k and _swings(ring, i)):
            break
        weight = 0.5 + 0.5 * math.cos(math.pi * away_s / half_s)
        weights += weight
        seen = not math.isnan(sample.mag_ut.sum())
        field_weights += weight if seen else 0.0
        for j in range(3):
            force_b[j] += weight * sample.accel_mps2[j]
            if seen:
                field_b[j] += weight * sample.mag_ut[j]
    for j in range(3):
        force_b[j] /= weights
        field_b[j] /= max(field_weights, 1e-9)


@njit()
def _swings(ring: Ring, k: int) -> bool:
    rate = ring[k & (len(ring) - 1)].gyro_radps
    return bool((rate * rate).sum() > QUIET_RADPS**2)


@njit()
def turn_upright(quaternion_nb: Floats, force_b_mps2: Floats) -> None:
    """Turn an attitude the shortest way so that the force at rest points up."""
    rotation_nb = np.zeros((3, 3))
    for _ in range(4):  # half a turn takes more than one
        rotation_matrix(quaternion_nb, rotation_nb)
        x = (rotation_nb[0] * force_b_mps2).sum()
        y = (rotation_nb[1] * force_b_mps2).sum()
        z = (rotation_nb[2] * force_b_mps2).sum()
        horizontal = math.sqrt(x * x + y * y)
        angle = math.atan2(horizontal, -z)
        if horizontal > 0.0:
            y, x = y / horizontal, x / horizontal
        else:
            y, x = 1.0, 0.0
        # Up is (0, 0, -1); the axis of the shortest turn is force x up = (-y, x, 0).
        # A vector of length 2 tan(angle / 2) makes rotate_navigation exact.
        length = 2.0 * math.tan(0.5 * angle) if angle < 3.1 else 40.0
        rotate_navigation(quaternion_nb, -y * length, x * length, 0.0)


@njit()
def turn_heading(quaternion_nb: Floats, turn_rad: float) -> None:
    """Turn an attitude clockwise about the vertical."""
    half = 0.25 * math.atan2(math.sin(turn_rad), math.cos(turn_rad))
    for _ in range(2):  # in halves: the tangent of a quarter turn is finite
        rotate_navigation(quaternion_nb, 0.0, 0.0, 2.0 * math.tan(half))
