"""Path filter: an error-state Kalman filter of the walked path, thirteen errors.

Steps carry position, heading and scale on.  A compass measures the earth's field as the heading is
off, plus the field of iron on the person, which turns along and stays, plus the bend of the field
here, which lasts for some metres.  Iron forgotten between two turns would pull the heading the same
way each time, and be taken for chance.  Measurements leave the position as it was walked (Schmidt's
consider filter): the covariance knows what that costs, and nothing jumps.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.body.config import UNKNOWN_PLACE, BodyConfig
from edge.tracker.body.state import (
    BEND,
    BIAS,
    EAST,
    ERRORS,
    FIELD,
    GAIN,
    HEADING,
    IRON,
    NORTH,
    SCALE,
    TICK_S,
    BodyState,
)
from edge.tracker.trunk.unseen_motion import unseen_m2

_UNKNOWN_UT = 60.0  # an axis, of a field of which nothing is known


@njit(cache=True)
def start_path(
    state: BodyState,
    iron_std_ut: float,
    gain_std: float,
    bias_std_radps: float,
    config: BodyConfig,
) -> None:
    """Begin at the origin with a heading that is the frame's."""
    covariance = state.covariance
    covariance[BIAS, BIAS] = state.bias_variance = bias_std_radps**2
    covariance[GAIN, GAIN] = gain_std**2
    covariance[SCALE, SCALE] = config.scale_std**2
    for i in range(2):
        covariance[FIELD + i, FIELD + i] = _UNKNOWN_UT**2
        covariance[BEND + i, BEND + i] = config.bend_std_ut**2
    for i in range(3):
        covariance[IRON + i, IRON + i] = iron_std_ut**2


@njit()
def propagate_heading(state: BodyState, config: BodyConfig) -> None:
    """Propagate the errors of heading over one tick: bias, gain and the bias's random walk."""
    estimate, covariance = state.estimate, state.covariance
    turn_rad = state.heading_rad - state.passed_rad
    state.passed_rad = state.heading_rad
    estimate[HEADING] += TICK_S * estimate[BIAS] + turn_rad * estimate[GAIN]
    for i in range(ERRORS):
        covariance[HEADING, i] += TICK_S * covariance[BIAS, i] + turn_rad * covariance[GAIN, i]
    for i in range(ERRORS):
        covariance[i, HEADING] += TICK_S * covariance[i, BIAS] + turn_rad * covariance[i, GAIN]
    covariance[HEADING, HEADING] += config.heading_walk_rad**2 * TICK_S
    covariance[BIAS, BIAS] += config.bias_walk_radps**2 * TICK_S


@njit()
def update_bias_at_rest(
    state: BodyState, turned_radps: float, moved_radps: float, config: BodyConfig
) -> None:
    """Update the bias by the turn rate at rest, less the correction made to the gyroscope."""
    row = state.row
    row[:] = 0.0
    row[BIAS] = 1.0
    _update(state, turned_radps - state.estimate[BIAS], config.sway_radps**2, math.inf)
    state.estimate[BIAS] -= moved_radps


@njit()
def propagate_step(
    state: BodyState, length_m: float, heading_rad: float, config: BodyConfig
) -> None:
    """Carry the position's errors over one step."""
    covariance = state.covariance
    north_m, east_m = length_m * math.cos(heading_rad), length_m * math.sin(heading_rad)
    # An error of the heading turns the step; one of the scale stretches it.
    for i in range(ERRORS):
        covariance[NORTH, i] += north_m * covariance[SCALE, i] - east_m * covariance[HEADING, i]
        covariance[EAST, i] += east_m * covariance[SCALE, i] + north_m * covariance[HEADING, i]
    for i in range(ERRORS):
        covariance[i, NORTH] += north_m * covariance[i, SCALE] - east_m * covariance[i, HEADING]
        covariance[i, EAST] += east_m * covariance[i, SCALE] + north_m * covariance[i, HEADING]
    variance_m2 = (step_std(state, config) * length_m) ** 2
    covariance[NORTH, NORTH] += variance_m2
    covariance[EAST, EAST] += variance_m2
    state.since_m += length_m


@njit()
def step_std(state: BodyState, config: BodyConfig) -> float:
    """Return the deviation of a single step by its length; what a hand holds goes its own way."""
    is_open = config.place == UNKNOWN_PLACE and state.direction_weight < config.recognised_steps
    if is_open or state.in_hand or state.in_pocket:
        return config.step_std
    return config.trunk_step_std


@njit()
def widen_by_unseen_motion(state: BodyState, config: BodyConfig) -> None:
    """Widen the position over a tick of motion that no step explains."""
    variance_m2 = unseen_m2(state.moving_s, TICK_S, config.unseen)
    state.covariance[NORTH, NORTH] += variance_m2
    state.covariance[EAST, EAST] += variance_m2


@njit()
def update_by_compass(state: BodyState, now_s: float, config: BodyConfig) -> None:
    """Measure the level field, a few times a second at most."""
    passed_s = now_s - state.filtered_s
    if not state.field_seen or passed_s < config.compass_s:
        return
    state.filtered_s = now_s
    _pass_field(state, passed_s, config)
    estimate, covariance = state.estimate, state.covariance
    for i in range(2):
        cosine, sine = math.cos(estimate[HEADING]), math.sin(estimate[HEADING])
        turned = (cosine, -sine) if i == 0 else (sine, cosine)
        _measure_field(state, i, turned)
        earth_ut = turned[0] * estimate[FIELD] + turned[1] * estimate[FIELD + 1]
        expected_ut = earth_ut + estimate[BEND + i]
        for j in range(3):
            expected_ut += state.level_nb[i, j] * estimate[IRON + j]
        # What is lost where heading and field are taken as linear: the terms of second order.
        heading_rad2 = covariance[HEADING, HEADING]
        field_ut2 = 0.5 * (covariance[FIELD, FIELD] + covariance[FIELD + 1, FIELD + 1])
        noise_ut2 = heading_rad2 * field_ut2 + 0.5 * (heading_rad2 * earth_ut) ** 2
        _update(
            state,
            state.field_n_ut[i] - expected_ut,
            noise_ut2 + config.compass_std_ut**2,
            config.outlier_sigmas,
        )


@njit()
def _measure_field(state: BodyState, i: int, turned: tuple[float, float]) -> None:
    """Write how one axis of the measured field depends on the errors."""
    row, estimate = state.row, state.estimate
    row[:] = 0.0
    row[HEADING] = turned[1] * estimate[FIELD] - turned[0] * estimate[FIELD + 1]
    for j in range(2):
        row[FIELD + j] = turned[j]
    for j in range(3):
        row[IRON + j] = state.level_nb[i, j]
    row[BEND + i] = 1.0


@njit()
def _update(state: BodyState, innovation: float, noise: float, sigmas: float) -> None:
    """P - K H P - (K H P)^T + K S K^T, with the gain of the position left at zero.

    An innovation beyond ``sigmas`` counts as if its noise made it as likely as that (Huber).
    """
    covariance, row, product = state.covariance, state.row, state.gain
    variance = noise
    for i in range(ERRORS):
        product[i] = 0.0
        for j in range(ERRORS):
            product[i] += covariance[i, j] * row[j]
        variance += row[i] * product[i]
    variance = max(variance, (innovation / sigmas) ** 2)
    for i in range(ERRORS):
        for j in range(ERRORS):
            if i >= 2 or j >= 2:
                covariance[i, j] -= product[i] * product[j] / variance
    for i in range(2, ERRORS):
        state.estimate[i] += product[i] / variance * innovation


@njit()
def _pass_field(state: BodyState, passed_s: float, config: BodyConfig) -> None:
    """Let the bend be forgotten over way and time, and iron be moved about."""
    kept = math.exp(-state.since_m / config.bend_m - passed_s / config.bend_s)
    state.since_m = 0.0
    for k in range(BEND, BEND + 2):
        state.estimate[k] *= kept
        for i in range(ERRORS):
            state.covariance[k, i] *= kept
        for i in range(ERRORS):
            state.covariance[i, k] *= kept
        state.covariance[k, k] += config.bend_std_ut**2 * (1.0 - kept * kept)
    for k in range(IRON, IRON + 3):
        state.covariance[k, k] += config.iron_walk_ut**2 * passed_s


@njit()
def low_pass_field(state: BodyState, mag_ut: Floats, dt_s: float, config: BodyConfig) -> None:
    """Take the level field of a sample, in the frame of the gyroscope's heading."""
    field_square = mag_ut[0] ** 2 + mag_ut[1] ** 2 + mag_ut[2] ** 2
    if math.isnan(field_square) or field_square == 0.0 or _is_disturbed(state, field_square):
        return
    share = min(dt_s / config.compass_s, 1.0) if state.field_seen else 1.0
    for i in range(2):
        row = state.rotation_nb[i]
        value = row[0] * mag_ut[0] + row[1] * mag_ut[1] + row[2] * mag_ut[2]
        state.field_n_ut[i] += share * (value - state.field_n_ut[i])
        for j in range(3):
            state.level_nb[i, j] += share * (row[j] - state.level_nb[i, j])
    state.field_seen = True


@njit()
def _is_disturbed(state: BodyState, field_square: float) -> bool:
    """True where the strength is not the earth's, and that is known."""
    if state.earth_ut <= 0.0:
        return False
    ratio = math.sqrt(field_square) / state.earth_ut
    return bool(ratio < 0.7 or ratio > 1.4)
