"""Attitude of the trunk by a complementary filter (Li et al. 2014, section 3.4).

The gyroscope turns the quaternion; a share of the angle between the felt and the assumed direction
of gravity, and of that between the measured and the assumed magnetic north, is put right each
second.  Rests show the gyroscope's bias, which neither of the two does about the vertical.

The compass counts where it is calibrated: iron beside the sensor turns an uncalibrated one by tens
of degrees, by another angle for each heading.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.mechanization.quasi_static import static_orientation
from edge.tracker.mechanization.strapdown import rotate_attitude, rotation_matrix
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.state import Row, TrunkConfig, TrunkState

_FIELD_GAP_S = 0.1  # a field that is older says nothing of the time between
_LEAST_FORCE_MPS2, _MOST_FORCE_MPS2 = 5.0, 15.0  # beyond these it is no gravity


@njit()
def begin_attitude(ring: Ring, trunk: TrunkState, k: int, config: TrunkConfig) -> None:
    """Take the first attitude from force and field, and the most level sensor axis for the front.

    Where the sensor faces on its wearer is not known, so the path has a frame of its own.
    """
    static_orientation(ring, trunk.timed, k, config.low_pass_s, 0.0, trunk)
    trunk.field_s = ring[k & (len(ring) - 1)].t_s
    level = 0
    for i in range(1, 3):
        if abs(trunk.rotation_nb[2, i]) < abs(trunk.rotation_nb[2, level]):
            level = i
    for i in range(3):
        trunk.forward_b[i] = 1.0 if i == level else 0.0


@njit()
def follow_attitude(
    ring: Ring, trunk: TrunkState, k: int, dt_s: float, angle_b_rad: Floats, config: TrunkConfig
) -> None:
    """Turn the attitude from sample ``k - 1`` to ``k``; ``angle_b_rad`` (3,) is scratch."""
    mask = len(ring) - 1
    here, before = ring[k & mask], ring[(k - 1) & mask]
    _follow_rest(here, trunk, dt_s, config)
    for i in range(3):
        rate_radps = 0.5 * (here.gyro_radps[i] + before.gyro_radps[i]) - trunk.gyro_bias_radps[i]
        angle_b_rad[i] = dt_s * rate_radps
    _add_tilt(here, trunk, dt_s, angle_b_rad, config)
    if trunk.has_compass:
        _add_heading(here, trunk, angle_b_rad, config)
    rotate_attitude(trunk.quaternion_nb, angle_b_rad)
    rotation_matrix(trunk.quaternion_nb, trunk.rotation_nb)


@njit()
def _follow_rest(here: Row, trunk: TrunkState, dt_s: float, config: TrunkConfig) -> None:
    norm_mps2 = norm_of(here.accel_mps2)
    off_mps2 = abs(norm_mps2 - trunk.rest_norm_mps2)
    trunk.rest_norm_mps2 += (norm_mps2 - trunk.rest_norm_mps2) * dt_s / config.norm_memory_s
    quiet = off_mps2 < config.quiet_mps2 and norm_of(here.gyro_radps) < config.quiet_radps
    trunk.quiet_s = trunk.quiet_s + dt_s if quiet else 0.0
    trunk.still = trunk.quiet_s >= config.rest_s
    if trunk.still:
        trunk.bias_s = min(trunk.bias_s + dt_s, config.bias_memory_s)
        for i in range(3):
            off_radps = here.gyro_radps[i] - trunk.gyro_bias_radps[i]
            trunk.gyro_bias_radps[i] += off_radps * dt_s / trunk.bias_s


@njit()
def _add_tilt(
    here: Row, trunk: TrunkState, dt_s: float, angle_b_rad: Floats, config: TrunkConfig
) -> None:
    """Add a share of the error of the tilt, as the paper's S_a x S_g."""
    force, rotation_nb = here.accel_mps2, trunk.rotation_nb
    norm_mps2 = norm_of(force)
    if not _LEAST_FORCE_MPS2 < norm_mps2 < _MOST_FORCE_MPS2:
        return
    gain = (config.tilt_at_rest_per_s if trunk.still else config.tilt_per_s) * dt_s / norm_mps2
    up_x, up_y, up_z = -rotation_nb[2, 0], -rotation_nb[2, 1], -rotation_nb[2, 2]
    angle_b_rad[0] += gain * (force[1] * up_z - force[2] * up_y)
    angle_b_rad[1] += gain * (force[2] * up_x - force[0] * up_z)
    angle_b_rad[2] += gain * (force[0] * up_y - force[1] * up_x)


@njit()
def _add_heading(here: Row, trunk: TrunkState, angle_b_rad: Floats, config: TrunkConfig) -> None:
    """Add a share of the error of the heading, as the paper's S_m x S_b about the vertical."""
    field, rotation_nb = here.mag_ut, trunk.rotation_nb
    north_ut = rotation_nb[0, 0] * field[0] + rotation_nb[0, 1] * field[1]
    north_ut += rotation_nb[0, 2] * field[2]
    east_ut = rotation_nb[1, 0] * field[0] + rotation_nb[1, 1] * field[1]
    east_ut += rotation_nb[1, 2] * field[2]
    level_ut = math.sqrt(north_ut * north_ut + east_ut * east_ut)
    if not level_ut > 1.0:
        return  # also where there is no reading
    since_s = min(here.t_s - trunk.field_s, _FIELD_GAP_S)
    trunk.field_s = here.t_s
    turn_rad = -config.compass_per_s * since_s * east_ut / level_ut
    if north_ut < 0.0:
        turn_rad = -math.copysign(config.compass_per_s * since_s, east_ut)
    for i in range(3):
        angle_b_rad[i] += turn_rad * rotation_nb[2, i]


@njit()
def norm_of(vector: Floats) -> float:
    """Return the length of a vector (3,)."""
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@njit()
def add_forward(ring: Ring, trunk: TrunkState, k: int, sum_n: Floats) -> None:
    """Add the horizontal direction (2,) of the front at sample ``k``, whose attitude is kept."""
    q = ring[k & (len(ring) - 1)].quaternion_nb
    w, x, y, z = q[0], q[1], q[2], q[3]
    f = trunk.forward_b
    north = (1.0 - 2.0 * (y * y + z * z)) * f[0]
    north += 2.0 * (x * y - w * z) * f[1] + 2.0 * (x * z + w * y) * f[2]
    east = 2.0 * (x * y + w * z) * f[0]
    east += (1.0 - 2.0 * (x * x + z * z)) * f[1] + 2.0 * (y * z - w * x) * f[2]
    level = math.sqrt(north * north + east * east)
    if level > 0.0:
        sum_n[0] += north / level
        sum_n[1] += east / level


@njit()
def level_force(row: Row, force_n: Floats) -> None:
    """Write the horizontal specific force (2,) of a sample whose attitude is kept."""
    q, f = row.quaternion_nb, row.accel_mps2
    w, x, y, z = q[0], q[1], q[2], q[3]
    force_n[0] = (1.0 - 2.0 * (y * y + z * z)) * f[0]
    force_n[0] += 2.0 * (x * y - w * z) * f[1] + 2.0 * (x * z + w * y) * f[2]
    force_n[1] = 2.0 * (x * y + w * z) * f[0]
    force_n[1] += (1.0 - 2.0 * (x * x + z * z)) * f[1] + 2.0 * (y * z - w * x) * f[2]
