"""Heading from the magnetic field, among steel and with an uncalibrated magnetometer.

How far steel distorts the field over a whole part of a building decides what it is worth, and
cannot be seen from one place.  So there are several hypotheses of it side by side (see
``magnetic_field``), each a filter of its own, weighted by the likelihood of the measurements on the
way (multiple-model estimation: Blackman and Popoli, "Design and Analysis of Modern Tracking
Systems", 1999, section 4.5).  The heading is the mean of the mixture: while a wide distortion is as
likely as none, its variance is large.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.aiding.aiding_filter import (
    equivalent_noise,
    residual_for_mean,
    sync_variance,
)
from edge.tracker.foot.aiding.magnetic_field import (
    decay_distortion,
    earth_log_likelihood,
    north_of,
    north_variance,
    set_field_direction,
    start_hypothesis,
    update_hypothesis,
)
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.filter.error_model import heading_variance
from edge.tracker.foot.filter.gap_turn import learn_gap_turn
from edge.tracker.foot.filter.initial_gyro_bias import is_bias_unobserved
from edge.tracker.foot.filter.measurement_update import begin_updates, end_updates, measure_heading
from edge.tracker.foot.state import Aid, FilterState, Step
from edge.tracker.preprocessing.sample_ring import Ring

ABSURD_UT = 1000.0  # twenty times the earth's field


@njit()
def update_magnetometer(
    ring: Ring, step: Step, state: FilterState, slot: int, still: bool, config: EskfConfig
) -> None:
    """Accumulate the field of a stance; update when the stance ends, or once a second."""
    compass = state.compass
    _write_north(ring, state, slot)
    if still and not is_bias_unobserved(state, config):
        _accumulate(ring, state, slot)
    if compass.samples == 0:
        return
    lasted_s = ring[slot].t_s - compass.since_s
    if still and lasted_s < config.aiding.update_s:
        return
    if lasted_s >= config.aiding.stance_s:
        _update(ring, step, state, slot, config)
    compass.samples = 0


@njit()
def _accumulate(ring: Ring, state: FilterState, slot: int) -> None:
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
        rotated = rotation[i, 0] * field[0] + rotation[i, 1] * field[1] + rotation[i, 2] * field[2]
        compass.field_n_ut[i] += share * (rotated - compass.field_n_ut[i])
        for j in range(3):
            compass.rotation_nb[i, j] += share * (rotation[i, j] - compass.rotation_nb[i, j])


@njit()
def _update(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Update all hypotheses by the mean of a stance, and the heading of the main filter."""
    compass = state.compass
    hypotheses = compass.hypotheses
    if not compass.started:
        compass.started = True
        for j in range(len(hypotheses)):
            wide_std_ut = config.field.wide_ut * config.field.wide_ratio**j
            start_hypothesis(hypotheses[j], wide_std_ut, compass.iron_std_ut, config)
    prior = heading_variance(state.covariance)
    moved_m = _moved_m(compass, state)
    for j in range(len(hypotheses)):
        _sync_heading_variance(compass, hypotheses[j], prior)
        decay_distortion(hypotheses[j], moved_m, config)
        update_hypothesis(compass, hypotheses[j], config)
    _normalise_weights(compass, config)
    mean, variance = _mean_heading(compass)
    noise = equivalent_noise(prior, variance)
    if noise < math.inf:
        begin_updates(state)
        measure_heading(step, state, residual_for_mean(mean, prior, noise), noise)
        end_updates(state)
        learn_gap_turn(state)
        for j in range(len(hypotheses)):
            hypotheses[j].estimate[0] -= mean
    compass.heading_var_rad2 = heading_variance(state.covariance)
    if compass.calibrated:
        known = compass.earth_known and ring[slot].t_ns >= compass.earth_from_ns
        _update_north(compass, known, config)
        _write_north(ring, state, slot)


@njit()
def _moved_m(compass: Aid, state: FilterState) -> float:
    north_m = state.position_n_m[0] - compass.north_m
    east_m = state.position_n_m[1] - compass.east_m
    compass.north_m, compass.east_m = state.position_n_m[0], state.position_n_m[1]
    return math.sqrt(north_m * north_m + east_m * east_m)


@njit()
def _sync_heading_variance(compass: Aid, hypothesis: Aid, prior: float) -> None:
    """Adopt what the main filter has lost of the heading since, or learned elsewhere."""
    before, own = compass.heading_var_rad2, hypothesis.covariance[0, 0]
    sync_variance(
        hypothesis.covariance, own + prior - before if prior >= before else own * prior / before
    )


@njit()
def _normalise_weights(compass: Aid, config: EskfConfig) -> None:
    """Make the weights' sum one; no belief is ever ruled out, for the next room may be another."""
    hypotheses = compass.hypotheses
    most = -math.inf
    for j in range(len(hypotheses)):
        most = max(most, hypotheses[j].log_weight)
    total = 0.0
    for j in range(len(hypotheses)):
        hypotheses[j].log_weight = max(
            hypotheses[j].log_weight - most, config.field.least_log_weight
        )
        hypotheses[j].weight = math.exp(hypotheses[j].log_weight)
        total += hypotheses[j].weight
    for j in range(len(hypotheses)):
        hypotheses[j].weight /= total


@njit()
def _mean_heading(compass: Aid) -> tuple[float, float]:
    """Return mean and variance of the error of heading over all beliefs."""
    mean = 0.0
    for j in range(len(compass.hypotheses)):
        mean += compass.hypotheses[j].weight * compass.hypotheses[j].estimate[0]
    variance = 0.0
    for j in range(len(compass.hypotheses)):
        hypothesis = compass.hypotheses[j]
        off = hypothesis.estimate[0] - mean
        variance += hypothesis.weight * (hypothesis.covariance[0, 0] + off * off)
    return mean, variance


@njit()
def _update_north(compass: Aid, earth_known: bool, config: EskfConfig) -> None:
    """Estimate the direction of magnetic north in the frame, from all hypotheses that count."""
    hypotheses = compass.hypotheses
    most = -math.inf
    for j in range(len(hypotheses)):
        set_field_direction(hypotheses[j])
        hypotheses[j].north_weight = hypotheses[j].log_weight
        if earth_known:
            hypotheses[j].north_weight += earth_log_likelihood(compass, hypotheses[j], config)
        most = max(most, hypotheses[j].north_weight)
    total, north, east = 0.0, 0.0, 0.0
    for j in range(len(hypotheses)):
        weight = math.exp(hypotheses[j].north_weight - most)
        hypotheses[j].north_weight = weight
        total += weight
        north += weight * math.cos(north_of(hypotheses[j]))
        east += weight * math.sin(north_of(hypotheses[j]))
    compass.north_rad = math.atan2(east, north)
    variance = 0.0
    for j in range(len(hypotheses)):
        weight = hypotheses[j].north_weight / total
        if weight > config.field.weight_min:
            off = north_of(hypotheses[j]) - compass.north_rad
            off = math.atan2(math.sin(off), math.cos(off))
            own = north_variance(compass, hypotheses[j], earth_known, config)
            variance += weight * (own + off * off)
    compass.north_var_rad2 = variance


@njit()
def _write_north(ring: Ring, state: FilterState, slot: int) -> None:
    """Write magnetic north into the row; since the last look the heading has drifted."""
    compass = state.compass
    drifted = max(heading_variance(state.covariance) - compass.heading_var_rad2, 0.0)
    ring[slot].magnetic_north_rad = compass.north_rad
    ring[slot].magnetic_north_std_rad = math.sqrt(compass.north_var_rad2 + drifted)
