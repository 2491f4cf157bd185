"""Heading from the magnetic field, among steel and with a magnetometer nobody calibrated.

Once a stance the mean field, turned into navigation axes by the tracker's attitude ``R``,
is compared with a model that is learned on the way:

    R m = f + R h + near + wide + d (f x down)

``f`` is the earth's field in the frame of the walk, the same wherever one goes; ``h`` is the
iron on the foot, the same in sensor axes, and told from ``f`` by turning about; ``near`` and
``wide`` are what steel does to the field, forgotten within a stride or two and within a
room; ``d`` is the error of heading that is looked for.  Only the horizontal component across
``f`` tells of ``d``.  The other two, along and vertical, tell how bent the field is just
here, and that is how much the one across is doubted.  North stays where the walk began:
nothing is taken for granted of declination, strength or dip.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import heading_variance
from edge.tracker.measuring import begin_updates, end_updates, measure_heading
from edge.tracker.side_filter import agree, handed_over, measure, project
from edge.tracker.state import COMPASS_SIZE, Aid, FilterState, Ring

FIELD, IRON, NEAR, WIDE = 1, 4, 7, 10  # three states each, after the error of heading
ALONG, VERTICAL, ACROSS = 0, 1, 2
ABSURD_UT = 1000.0  # twenty times the earth's field


@njit()
def heed_field(ring: Ring, state: FilterState, slot: int, still: bool, config: EskfConfig) -> None:
    """Gather the field of a stance; look at it when the stance ends, or once a second."""
    compass = state.compass
    _write_north(ring, state, slot)
    if still:
        _gather(ring, state, slot)
    if compass.samples == 0:
        return
    lasted_s = ring[slot].t_s - compass.since_s
    if still and lasted_s < config.aid_look_s:
        return
    if lasted_s >= config.aid_stance_s:
        _look(ring, state, slot, config)
    compass.samples = 0


@njit()
def _gather(ring: Ring, state: FilterState, slot: int) -> None:
    compass = state.compass
    field = ring[slot].mag_ut
    square = field[0] * field[0] + field[1] * field[1] + field[2] * field[2]
    if not square < ABSURD_UT**2:
        return  # also when it is not a number
    if compass.samples == 0:
        compass.since_s = ring[slot].t_s
        for i in range(3):
            compass.field_n_ut[i] = 0.0
            for j in range(3):
                compass.rotation_nb[i, j] = 0.0
    compass.samples += 1
    share = 1.0 / compass.samples
    rotation = state.rotation_nb
    for i in range(3):
        turned = rotation[i, 0] * field[0] + rotation[i, 1] * field[1] + rotation[i, 2] * field[2]
        compass.field_n_ut[i] += share * (turned - compass.field_n_ut[i])
        for j in range(3):
            compass.rotation_nb[i, j] += share * (rotation[i, j] - compass.rotation_nb[i, j])


@njit()
def _look(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Learn the model from the mean of a stance, and the heading from the model."""
    compass = state.compass
    if not compass.started:
        _start(compass, config)
    prior = heading_variance(state.covariance)
    agree(compass.covariance, prior)
    _leave(compass, state, config)
    _aim(compass)
    _judge_bend(compass, config)
    for axis in range(3):
        variance = component_row(compass, axis, config)
        residual = _residual(compass)
        expected = project(compass.covariance, compass.row, compass.column) + variance
        if residual * residual > config.aid_gate**2 * expected:
            continue
        measure(
            compass.estimate,
            compass.covariance,
            compass.row,
            residual,
            variance,
            compass.column,
        )
    residual_rad, variance = handed_over(compass.estimate, compass.covariance, prior)
    if variance < math.inf:
        begin_updates(state)
        measure_heading(ring, state, slot, residual_rad, variance)
        end_updates(state)
    _find_north(ring, state, slot, config)
    _write_north(ring, state, slot)


@njit()
def _find_north(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Judge where magnetic north lies in the frame as the main filter has it now.

    The frame is the walk's, turned by the error of heading, and both are known together.  To
    what the model itself knows is added what it cannot: a field that is bent alike all over,
    which shows, where the earth's is known, by strength and dip.
    """
    compass = state.compass
    if not compass.calibrated:
        return
    _aim(compass)
    p = compass.covariance
    ahead, right, strength = compass.aim_n[0], compass.aim_n[1], compass.strength_ut
    compass.heading_var_rad2 = heading_variance(state.covariance)
    compass.north_var_rad2 = math.inf
    spread = p[FIELD, FIELD] + p[FIELD + 1, FIELD + 1]
    if not strength * strength > config.field_known_ratio**2 * spread:
        return
    across_var = right * right * p[FIELD, FIELD] + ahead * ahead * p[FIELD + 1, FIELD + 1]
    across_var -= 2.0 * right * ahead * p[FIELD, FIELD + 1]
    with_heading = ahead * p[FIELD + 1, 0] - right * p[FIELD, 0]
    everywhere_var = config.field_everywhere_ut**2
    if compass.earth_known and ring[slot].t_ns >= compass.earth_from_ns:
        off_along_ut = strength - compass.earth_horizontal_ut
        off_down_ut = compass.estimate[FIELD + 2] - compass.earth_down_ut
        everywhere_var = config.field_agreeing_ut**2
        everywhere_var += 0.5 * (off_along_ut * off_along_ut + off_down_ut * off_down_ut)
    variance = (across_var + everywhere_var) / (strength * strength)
    variance += p[0, 0] - 2.0 * with_heading / strength
    compass.north_rad = math.atan2(right, ahead) - compass.estimate[0]
    compass.north_var_rad2 = variance


@njit()
def _write_north(ring: Ring, state: FilterState, slot: int) -> None:
    """Write magnetic north into the row; since the last look the heading has drifted."""
    compass = state.compass
    drifted = max(heading_variance(state.covariance) - compass.heading_var_rad2, 0.0)
    ring[slot].magnetic_north_rad = compass.north_rad
    ring[slot].magnetic_north_std_rad = math.sqrt(compass.north_var_rad2 + drifted)


@njit()
def _start(compass: Aid, config: EskfConfig) -> None:
    compass.started = True
    compass.bend_var_ut2 = config.field_bend_start_ut**2
    for i in range(3):
        compass.covariance[FIELD + i, FIELD + i] = config.field_std_ut**2
        compass.covariance[IRON + i, IRON + i] = compass.iron_std_ut**2
        compass.covariance[WIDE + i, WIDE + i] = config.field_wide_share**2 * compass.bend_var_ut2


@njit()
def _leave(compass: Aid, state: FilterState, config: EskfConfig) -> None:
    """Forget what steel did where the foot stood before, as far as it has moved since."""
    north_m = state.position_n_m[0] - compass.north_m
    east_m = state.position_n_m[1] - compass.east_m
    moved_m = math.sqrt(north_m * north_m + east_m * east_m)
    compass.north_m, compass.east_m = state.position_n_m[0], state.position_n_m[1]
    near = math.exp(-moved_m / config.field_near_m)
    wide = math.exp(-moved_m / config.field_wide_m)
    _fade(compass, NEAR, near)
    _fade(compass, WIDE, wide)
    compass.near_is_new = 1.0 - near * near
    compass.wide_is_new = 1.0 - wide * wide


@njit()
def _fade(compass: Aid, first: int, kept: float) -> None:
    for i in range(first, first + 3):
        compass.estimate[i] *= kept
        for j in range(COMPASS_SIZE):
            compass.covariance[i, j] *= kept
        for j in range(COMPASS_SIZE):
            compass.covariance[j, i] *= kept


@njit()
def _judge_bend(compass: Aid, config: EskfConfig) -> None:
    """Judge how bent the field is here by the components that no heading changes.

    Doubt comes at once and goes slowly.
    """
    bend_var = compass.bend_var_ut2
    for axis in (ALONG, VERTICAL):
        expected = component_row(compass, axis, config)
        expected += project(compass.covariance, compass.row, compass.column)
        residual = _residual(compass)
        seen = max(residual * residual - expected, 0.0)
        weight = config.field_bend_rise if seen > bend_var else config.field_bend_fall
        weight *= compass.near_is_new * bend_var / (bend_var + expected)
        bend_var += weight * (seen - bend_var)
    bend_var = max(bend_var, config.field_bend_floor_ut**2)
    compass.bend_var_ut2 = bend_var
    wide_var = config.field_wide_share**2 * bend_var
    for i in range(3):
        compass.covariance[NEAR + i, NEAR + i] += compass.near_is_new * bend_var
        compass.covariance[WIDE + i, WIDE + i] += compass.wide_is_new * wide_var


@njit()
def _aim(compass: Aid) -> None:
    """Set the horizontal direction of ``f``; north where it is unknown."""
    north, east = compass.estimate[FIELD], compass.estimate[FIELD + 1]
    strength = math.sqrt(north * north + east * east)
    compass.strength_ut = strength
    compass.aim_n[0] = north / strength if strength > 0.0 else 1.0
    compass.aim_n[1] = east / strength if strength > 0.0 else 0.0


@njit()
def component_row(compass: Aid, axis: int, config: EskfConfig) -> float:
    """Write the measurement row of one component; return the variance that is its own.

    That includes what the linear model leaves out: the product of the errors of heading and
    of ``f``, and that sine and cosine are no straight lines.
    """
    ahead, right = compass.aim_n[0], compass.aim_n[1]
    heading_var = compass.covariance[0, 0]
    strength = compass.strength_ut
    variance = config.field_noise_ut**2
    sensitivity = 0.0
    if axis == ALONG:
        x, y, z = ahead, right, 0.0
        variance += 0.5 * (heading_var * strength) ** 2
    elif axis == VERTICAL:
        x, y, z = 0.0, 0.0, 1.0
    else:
        x, y, z = -right, ahead, 0.0
        spread = compass.covariance[FIELD, FIELD] + compass.covariance[FIELD + 1, FIELD + 1]
        variance += heading_var * spread
        bend_ratio = compass.bend_var_ut2 / max(strength * strength, 1.0)
        variance += compass.bend_var_ut2 * bend_ratio / config.field_bend_ratio**2
        known = strength * strength > config.field_known_ratio**2 * spread
        if known and bend_ratio < config.field_bend_limit**2:
            sensitivity = -strength
            variance += heading_var**3 * strength**2 * 5.0 / 12.0
        else:
            variance += heading_var * strength**2
    row, rotation = compass.row, compass.rotation_nb
    for first in (FIELD, NEAR, WIDE):
        row[first], row[first + 1], row[first + 2] = x, y, z
    for i in range(3):
        row[IRON + i] = x * rotation[0, i] + y * rotation[1, i] + z * rotation[2, i]
    row[0] = sensitivity
    return float(variance)


@njit()
def _residual(compass: Aid) -> float:
    """Return the measured component beyond the one expected, for the row just written."""
    seen = 0.0
    for i in range(3):
        seen += compass.row[FIELD + i] * compass.field_n_ut[i]
    for i in range(COMPASS_SIZE):
        seen -= compass.row[i] * compass.estimate[i]
    return float(seen)
