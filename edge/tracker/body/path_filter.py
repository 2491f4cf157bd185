"""Path filter: an error-state Kalman filter of the walked path, seven errors.

Steps carry position, heading and scale on; the compass measures heading plus the direction of
magnetic north plus the bend of the field here, which lasts for some metres and for as long as iron
on the person is not turned.  Measurements leave the position as it was walked (Schmidt's consider
filter): the covariance knows what that costs, and nothing jumps.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import (
    BEND,
    BIAS,
    EAST,
    ERRORS,
    HEADING,
    MAGNETIC_NORTH,
    NORTH,
    SCALE,
    TICK_S,
    BodyState,
)

_UNKNOWN_RAD2 = 10.0  # of a direction of which nothing is known


@njit()
def start_path(state: BodyState, config: BodyConfig) -> None:
    """Begin at the origin with a heading that is the frame's."""
    covariance = state.covariance
    covariance[BIAS, BIAS] = state.bias_variance = config.first_bias_std_radps**2
    covariance[MAGNETIC_NORTH, MAGNETIC_NORTH] = _UNKNOWN_RAD2
    covariance[BEND, BEND] = config.bend_std_rad**2
    covariance[SCALE, SCALE] = config.scale_std**2


@njit()
def pass_tick(state: BodyState, config: BodyConfig) -> None:
    """Let the heading run off by its bias for one tick, and the bias wander."""
    estimate, covariance = state.estimate, state.covariance
    estimate[HEADING] += TICK_S * estimate[BIAS]
    for i in range(ERRORS):
        covariance[HEADING, i] += TICK_S * covariance[BIAS, i]
    for i in range(ERRORS):
        covariance[i, HEADING] += TICK_S * covariance[i, BIAS]
    covariance[HEADING, HEADING] += config.heading_walk_rad**2 * TICK_S
    covariance[BIAS, BIAS] += config.bias_walk_radps**2 * TICK_S


@njit()
def walk_step(state: BodyState, length_m: float, heading_rad: float, config: BodyConfig) -> None:
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
    variance_m2 = (config.step_std * length_m) ** 2
    covariance[NORTH, NORTH] += variance_m2
    covariance[EAST, EAST] += variance_m2
    state.since_m += length_m


@njit()
def take_unseen_motion(state: BodyState, config: BodyConfig) -> None:
    """Widen the position over a tick of motion that no step explains."""
    variance_m2 = config.unseen_mps**2 * TICK_S
    state.covariance[NORTH, NORTH] += variance_m2
    state.covariance[EAST, EAST] += variance_m2


@njit()
def take_compass(state: BodyState, now_s: float, config: BodyConfig) -> None:
    """Measure the direction of the field, a few times a second at most."""
    passed_s = now_s - state.filtered_s
    if not state.field_seen or passed_s < config.compass_s:
        return
    state.filtered_s = now_s
    _fade_bend(state, passed_s, config)
    estimate, covariance, gain = state.estimate, state.covariance, state.gain
    seen_rad = math.atan2(state.field_n_ut[1], state.field_n_ut[0])
    expected_rad = estimate[HEADING] + estimate[MAGNETIC_NORTH] + estimate[BEND]
    difference_rad = seen_rad - expected_rad
    innovation_rad = math.atan2(math.sin(difference_rad), math.cos(difference_rad))
    for i in range(ERRORS):
        gain[i] = covariance[i, HEADING] + covariance[i, MAGNETIC_NORTH] + covariance[i, BEND]
    variance = gain[HEADING] + gain[MAGNETIC_NORTH] + gain[BEND] + config.compass_std_rad**2
    if innovation_rad**2 > config.outlier_sigmas**2 * variance:
        # Either the field or the heading is worse than believed, and which is not known.
        covariance[HEADING, HEADING] += 0.01 * innovation_rad**2
        covariance[BEND, BEND] += 0.01 * innovation_rad**2
        return
    _update(covariance, gain, variance)
    for i in range(2, ERRORS):
        estimate[i] += gain[i] / variance * innovation_rad


@njit()
def _update(covariance: Floats, product: Floats, variance: float) -> None:
    """P - K H P - (K H P)^T + K S K^T, with the gain of the position left at zero.

    ``product``: P H^T.
    """
    for i in range(ERRORS):
        for j in range(ERRORS):
            if i >= 2 or j >= 2:
                covariance[i, j] -= product[i] * product[j] / variance


@njit()
def _fade_bend(state: BodyState, passed_s: float, config: BodyConfig) -> None:
    """Let the bend be forgotten over way, turns and time."""
    way = state.since_m / config.bend_m
    kept = math.exp(-way - state.since_rad / config.bend_turn_rad - passed_s / config.bend_s)
    # What a turn adds to the heading's error by the gyroscope's scale.
    state.covariance[HEADING, HEADING] += (config.gain_std * state.since_rad) ** 2 * 0.1
    state.since_m = state.since_rad = 0.0
    state.estimate[BEND] *= kept
    for i in range(ERRORS):
        state.covariance[BEND, i] *= kept
    for i in range(ERRORS):
        state.covariance[i, BEND] *= kept
    state.covariance[BEND, BEND] += config.bend_std_rad**2 * (1.0 - kept * kept)


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
    state.field_seen = True


@njit()
def _is_disturbed(state: BodyState, field_square: float) -> bool:
    """True where the strength is not the earth's, and that is known."""
    if state.earth_ut <= 0.0:
        return False
    ratio = math.sqrt(field_square) / state.earth_ut
    return bool(ratio < 0.7 or ratio > 1.4)
