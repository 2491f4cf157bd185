"""Strapdown core: attitude, velocity and position from one inertial sample.

Frames: sensor axes (any mount) and NED navigation axes.  Quaternions are
Hamilton ``[w, x, y, z]`` and take sensor axes to navigation axes.  The earth's
rotation is left out: over the minutes between stances of a foot it is far
below what these sensors resolve.  Formulas: Savage, "Strapdown inertial
navigation integration algorithm design", 1998.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats

GRAVITY_MPS2 = 9.80665
SERIES_MAX_RAD2 = 0.01  # below, what the series of sine and cosine leave out is rounded away


@njit()
def dot(a: Floats, b: Floats) -> float:
    """Return the product of two vectors (3,)."""
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@njit()
def rotate_attitude(quaternion_nb: Floats, angle_b_rad: Floats) -> None:
    """Turn ``quaternion_nb`` (4,) in place by a rotation vector (3,) in sensor axes."""
    x, y, z = angle_b_rad[0], angle_b_rad[1], angle_b_rad[2]
    s = 0.25 * (x * x + y * y + z * z)  # square of half the angle
    if s < SERIES_MAX_RAD2:
        scale = 0.5 - s / 12.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0)))
        c = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)))
    else:
        half = math.sqrt(s)
        scale = 0.5 * math.sin(half) / half
        c = math.cos(half)
    x, y, z = scale * x, scale * y, scale * z
    qw, qx, qy, qz = quaternion_nb[0], quaternion_nb[1], quaternion_nb[2], quaternion_nb[3]
    w = qw * c - qx * x - qy * y - qz * z
    i = qw * x + qx * c + qy * z - qz * y
    j = qw * y - qx * z + qy * c + qz * x
    k = qw * z + qx * y - qy * x + qz * c
    norm = math.sqrt(w * w + i * i + j * j + k * k)
    quaternion_nb[0], quaternion_nb[1] = w / norm, i / norm
    quaternion_nb[2], quaternion_nb[3] = j / norm, k / norm


@njit()
def rotate_navigation(quaternion_nb: Floats, x: float, y: float, z: float) -> None:
    """Turn ``quaternion_nb`` in place by the small rotation vector in navigation axes."""
    qw, qx, qy, qz = quaternion_nb[0], quaternion_nb[1], quaternion_nb[2], quaternion_nb[3]
    x, y, z = 0.5 * x, 0.5 * y, 0.5 * z
    w = qw - x * qx - y * qy - z * qz
    i = qx + x * qw + y * qz - z * qy
    j = qy - x * qz + y * qw + z * qx
    k = qz + x * qy - y * qx + z * qw
    norm = math.sqrt(w * w + i * i + j * j + k * k)
    quaternion_nb[0], quaternion_nb[1] = w / norm, i / norm
    quaternion_nb[2], quaternion_nb[3] = j / norm, k / norm


@njit()
def rotation_matrix(quaternion_nb: Floats, rotation_nb: Floats) -> None:
    """Write the matrix of ``quaternion_nb`` into ``rotation_nb`` (3, 3)."""
    w, x, y, z = quaternion_nb[0], quaternion_nb[1], quaternion_nb[2], quaternion_nb[3]
    rotation_nb[0, 0] = 1.0 - 2.0 * (y * y + z * z)
    rotation_nb[0, 1] = 2.0 * (x * y - w * z)
    rotation_nb[0, 2] = 2.0 * (x * z + w * y)
    rotation_nb[1, 0] = 2.0 * (x * y + w * z)
    rotation_nb[1, 1] = 1.0 - 2.0 * (x * x + z * z)
    rotation_nb[1, 2] = 2.0 * (y * z - w * x)
    rotation_nb[2, 0] = 2.0 * (x * z - w * y)
    rotation_nb[2, 1] = 2.0 * (y * z + w * x)
    rotation_nb[2, 2] = 1.0 - 2.0 * (x * x + y * y)


@njit()
def advance(
    position_n_m: Floats,
    velocity_n_mps: Floats,
    quaternion_nb: Floats,
    rotation_nb: Floats,
    accel_b_mps2: Floats,
    gyro_b_radps: Floats,
    gravity_mps2: float,
    dt_s: float,
    force_n_mps2: Floats,
    angle_b_rad: Floats,
) -> None:
    """Move position, velocity and attitude (in place) over one interval.

    ``accel_b_mps2`` and ``gyro_b_radps`` are the means over the interval.  The
    specific force is turned at the attitude of the interval's middle.
    ``rotation_nb`` leaves as the matrix at the end, ``force_n_mps2`` as the specific
    force in navigation axes; ``angle_b_rad`` is scratch.
    """
    for i in range(3):
        angle_b_rad[i] = 0.5 * dt_s * gyro_b_radps[i]
    rotate_attitude(quaternion_nb, angle_b_rad)
    rotation_matrix(quaternion_nb, rotation_nb)
    for i in range(3):
        force_n_mps2[i] = (
            rotation_nb[i, 0] * accel_b_mps2[0]
            + rotation_nb[i, 1] * accel_b_mps2[1]
            + rotation_nb[i, 2] * accel_b_mps2[2]
        )
    rotate_attitude(quaternion_nb, angle_b_rad)
    rotation_matrix(quaternion_nb, rotation_nb)
    for i in range(3):
        step_mps = force_n_mps2[i] * dt_s
        if i == 2:
            step_mps += gravity_mps2 * dt_s
        position_n_m[i] += dt_s * (velocity_n_mps[i] + 0.5 * step_mps)
        velocity_n_mps[i] += step_mps
