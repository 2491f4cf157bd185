"""Heading from the magnetic field, among steel and with a magnetometer nobody calibrated.

How far steel bends the field over a whole part of a building decides how much it tells, and
cannot be seen from one place.  So there are several beliefs of it side by side (see
``magnetic_field``), each a filter of its own, and each as likely as what is seen on the way
was by it (Blackman and Popoli, "Design and Analysis of Modern Tracking Systems", 1999,
section 4.5).  The heading is what all of them say together: while a wide bend is as likely as
none, they say little.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import heading_variance
from edge.tracker.first_rest import is_bias_doubted
from edge.tracker.magnetic_field import (
    aim,
    earth_log_likelihood,
    expect,
    learn,
    leave,
    north_of,
    north_variance,
)
from edge.tracker.measurement_update import begin_updates, end_updates, measure_heading
from edge.tracker.side_filter import agree, noise_to_tell, told_residual
from edge.tracker.state import Aid, FilterState, Ring, Step

ABSURD_UT = 1000.0  # twenty times the earth's field


@njit()
def heed_field(
    ring: Ring, step: Step, state: FilterState, slot: int, still: bool, config: EskfConfig
) -> None:
    """Gather the field of a stance; look at it when the stance ends, or once a second."""
    compass = state.compass
    _write_north(ring, state, slot)
    if still and not is_bias_doubted(state, config):
        _gather(ring, state, slot)
    if compass.samples == 0:
        return
    lasted_s = ring[slot].t_s - compass.since_s
    if still and lasted_s < config.aid_look_s:
        return
    if lasted_s >= config.aid_stance_s:
        _look(ring, step, state, slot, config)
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
def _look(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Learn from the mean of a stance, and tell the main filter of the heading."""
    compass = state.compass
    beliefs = compass.beliefs
    if not compass.started:
        compass.started = True
        for j in range(len(beliefs)):
            wide_std_ut = config.field_wide_ut * config.field_wide_ratio**j
            expect(beliefs[j], wide_std_ut, compass.iron_std_ut, config)
    prior = heading_variance(state.covariance)
    moved_m = _moved_m(compass, state)
    for j in range(len(beliefs)):
        _agree_on_heading(compass, beliefs[j], prior)
        leave(beliefs[j], moved_m, config)
        learn(compass, beliefs[j], config)
    _weigh(compass, config)
    mean, variance = _heading_of(compass)
    noise = noise_to_tell(prior, variance)
    if noise < math.inf:
        begin_updates(state)
        measure_heading(step, state, told_residual(mean, prior, noise), noise)
        end_updates(state)
        for j in range(len(beliefs)):
            beliefs[j].estimate[0] -= mean
    compass.heading_var_rad2 = heading_variance(state.covariance)
    if compass.calibrated:
        known = compass.earth_known and ring[slot].t_ns >= compass.earth_from_ns
        _find_north(compass, known, config)
        _write_north(ring, state, slot)


@njit()
def _moved_m(compass: Aid, state: FilterState) -> float:
    north_m = state.position_n_m[0] - compass.north_m
    east_m = state.position_n_m[1] - compass.east_m
    compass.north_m, compass.east_m = state.position_n_m[0], state.position_n_m[1]
    return math.sqrt(north_m * north_m + east_m * east_m)


@njit()
def _agree_on_heading(compass: Aid, belief: Aid, prior: float) -> None:
    """Give a belief what the main filter has lost of the heading since, or learned elsewhere."""
    before, own = compass.heading_var_rad2, belief.covariance[0, 0]
    agree(belief.covariance, own + prior - before if prior >= before else own * prior / before)


@njit()
def _weigh(compass: Aid, config: EskfConfig) -> None:
    """Make the weights' sum one; no belief is ever ruled out, for the next room may be another."""
    beliefs = compass.beliefs
    most = -math.inf
    for j in range(len(beliefs)):
        most = max(most, beliefs[j].log_weight)
    total = 0.0
    for j in range(len(beliefs)):
        beliefs[j].log_weight = max(beliefs[j].log_weight - most, config.field_least_log_weight)
        beliefs[j].weight = math.exp(beliefs[j].log_weight)
        total += beliefs[j].weight
    for j in range(len(beliefs)):
        beliefs[j].weight /= total


@njit()
def _heading_of(compass: Aid) -> tuple[float, float]:
    """Return mean and variance of the error of heading over all beliefs."""
    mean = 0.0
    for j in range(len(compass.beliefs)):
        mean += compass.beliefs[j].weight * compass.beliefs[j].estimate[0]
    variance = 0.0
    for j in range(len(compass.beliefs)):
        belief = compass.beliefs[j]
        off = belief.estimate[0] - mean
        variance += belief.weight * (belief.covariance[0, 0] + off * off)
    return mean, variance


@njit()
def _find_north(compass: Aid, earth_known: bool, config: EskfConfig) -> None:
    """Say where magnetic north lies in the frame, by all beliefs that count."""
    beliefs = compass.beliefs
    most = -math.inf
    for j in range(len(beliefs)):
        aim(beliefs[j])
        beliefs[j].north_weight = beliefs[j].log_weight
        if earth_known:
            beliefs[j].north_weight += earth_log_likelihood(compass, beliefs[j], config)
        most = max(most, beliefs[j].north_weight)
    total, north, east = 0.0, 0.0, 0.0
    for j in range(len(beliefs)):
        weight = math.exp(beliefs[j].north_weight - most)
        beliefs[j].north_weight = weight
        total += weight
        north += weight * math.cos(north_of(beliefs[j]))
        east += weight * math.sin(north_of(beliefs[j]))
    compass.north_rad = math.atan2(east, north)
    variance = 0.0
    for j in range(len(beliefs)):
        weight = beliefs[j].north_weight / total
        if weight > config.field_counts:
            off = north_of(beliefs[j]) - compass.north_rad
            off = math.atan2(math.sin(off), math.cos(off))
            own = north_variance(compass, beliefs[j], earth_known, config)
            variance += weight * (own + off * off)
    compass.north_var_rad2 = variance


@njit()
def _write_north(ring: Ring, state: FilterState, slot: int) -> None:
    """Write magnetic north into the row; since the last look the heading has drifted."""
    compass = state.compass
    drifted = max(heading_variance(state.covariance) - compass.heading_var_rad2, 0.0)
    ring[slot].magnetic_north_rad = compass.north_rad
    ring[slot].magnetic_north_std_rad = math.sqrt(compass.north_var_rad2 + drifted)
