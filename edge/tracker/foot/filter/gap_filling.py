"""Propagation through a gap in the samples that is shorter than a stride.

Where one or two samples are missing the cubic through those around is used (see integration).  A
longer gap is filled with the mean readings of similar strides (see similar_strides), bent so that
they meet the readings at both ends.  By recorded walks the error of that is like noise, equal about
and along all axes, and grows with the difference between those strides.

Without similar strides, rate and force are straight lines from one end to the other.  Their error
is taken from the variance of the readings in the strides around, about and along the same axes:
what a line misses of a swing is mostly a turn about the axis on which a foot rolls, which the next
stance corrects.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, POSITION, VELOCITY
from edge.tracker.foot.filter.gap_turn import add_gap_turn
from edge.tracker.foot.filter.integration import accel_scale, integrate
from edge.tracker.foot.preprocessing.similar_strides import last_good, lost_periods
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.preprocessing.sample_ring import Ring, reach, span


@njit()
def propagate_through_gap(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Move the state over the gap before sample ``k`` with the readings of the similar strides.

    Leaves the means over the hole as if it were an interval.
    """
    periods = lost_periods(ring, k)
    scale = accel_scale(ring[k & (len(ring) - 1)].rest_norm_mps2, config)
    state.gap_means[:] = 0.0
    for n in range(periods):
        _write_readings(ring, progress, state, k, n)
        for i in range(3):
            state.gyro_radps[i] -= state.gyro_bias_radps[i]
            state.accel_mps2[i] = scale * state.accel_mps2[i] - state.accel_bias_mps2[i]
        integrate(state, dt_s / periods, config)
        for i in range(3):
            state.gap_means[0, i] += state.gyro_radps[i] / periods
            state.gap_means[1, i] += state.accel_mps2[i] / periods
            state.gap_means[2, i] += state.force_n_mps2[i] / periods
    for i in range(3):
        state.gyro_radps[i] = state.gap_means[0, i]
        state.accel_mps2[i] = state.gap_means[1, i]
        state.force_n_mps2[i] = state.gap_means[2, i]


@njit()
def _write_readings(ring: Ring, progress: Progress, state: FilterState, k: int, n: int) -> None:
    """Write the mean readings of period ``n`` of the hole before ``k``, as the sensor has them."""
    mask = len(ring) - 1
    periods = lost_periods(ring, k)
    start, end = ring[last_good(ring, k) & mask], ring[k & mask]
    late = (n + 0.5) / periods
    for i in range(3):
        state.gyro_radps[i] = _interpolate(start.gyro_radps[i], end.gyro_radps[i], late)
        state.accel_mps2[i] = _interpolate(start.accel_mps2[i], end.accel_mps2[i], late)
    for s in range(progress.similar_count):
        at, weight = progress.similar_at[s], progress.similar_weight[s]
        first, last = ring[at & mask], ring[(at + periods) & mask]
        a, b = ring[(at + n) & mask], ring[(at + n + 1) & mask]
        for i in range(3):
            rate = 0.5 * (a.gyro_radps[i] + b.gyro_radps[i])
            rate -= _interpolate(first.gyro_radps[i], last.gyro_radps[i], late)
            state.gyro_radps[i] += weight * rate
            force = 0.5 * (a.accel_mps2[i] + b.accel_mps2[i])
            force -= _interpolate(first.accel_mps2[i], last.accel_mps2[i], late)
            state.accel_mps2[i] += weight * force


@njit()
def _interpolate(first: float, last: float, late: float) -> float:
    return (1.0 - late) * first + late * last


@njit()
def inflate_for_gap(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Add to the covariance what may have been missed in the gap before sample ``k``."""
    rates, forces = np.zeros((3, 3)), np.zeros((3, 3))
    _write_reading_covariances(ring, progress, k, dt_s, rates, forces, config)
    held_rates, held_forces = _held_reading_variances(ring, k, rates, forces, config)
    noise_s2 = dt_s**3 / config.gap.similar_rate_s, dt_s**3 / config.gap.similar_force_s
    if progress.similar_count:
        turns, pushes = _similar_stride_variances(ring, progress, k, dt_s)
        turn_var = np.trace(rates) * noise_s2[0] + config.gap.similar_spread_weight * turns
        push_var = np.trace(forces) * noise_s2[1] + config.gap.similar_spread_weight * pushes
        rates, forces = np.eye(3) * turn_var / 3.0, np.eye(3) * push_var / 3.0
    else:  # a line is no better than a like stride
        rates *= max(noise_s2[0], _line_error_s(dt_s, config.gap.rate_s) ** 2)
        forces *= max(noise_s2[1], _line_error_s(dt_s, config.gap.force_s) ** 2)
    for i in range(3):
        rates[i, i] += held_rates[i]
        forces[i, i] += held_forces[i]
    rotation = state.rotation_nb
    rotated, pushed = rotation @ rates @ rotation.T, rotation @ forces @ rotation.T
    add_gap_turn(state, rotated[2, 2])
    p = state.covariance
    for i in range(3):
        for j in range(3):
            p[ATTITUDE + i, ATTITUDE + j] += rotated[i, j]
            p[VELOCITY + i, VELOCITY + j] += pushed[i, j]
            p[POSITION + i, VELOCITY + j] += pushed[i, j] * dt_s / 2.0
            p[VELOCITY + i, POSITION + j] += pushed[i, j] * dt_s / 2.0
            p[POSITION + i, POSITION + j] += pushed[i, j] * dt_s**2 / 3.0


@njit()
def _held_reading_variances(
    ring: Ring, k: int, rates: Floats, forces: Floats, config: EskfConfig
) -> tuple[Floats, Floats]:
    """Return the variances of turn and push, sensor axes (3,) each, before a hang is known.

    Until it has repeated itself for long enough, what it repeats is taken for motion.  ``rates``
    and ``forces`` are the covariances of the readings.
    """
    held_rates, held_forces = np.zeros(3), np.zeros(3)
    last = last_good(ring, k)
    if last == k - 1:
        return held_rates, held_forces  # samples are lost
    period_s = ring[k & (len(ring) - 1)].period_s
    for axis in range(3):
        held_s = period_s * _repeats(ring, last, axis, False)
        held_rates[axis] = rates[axis, axis] * _held_error_s(held_s, config.gap.rate_s) ** 2
        held_s = period_s * _repeats(ring, last, axis, True)
        held_forces[axis] = forces[axis, axis] * _held_error_s(held_s, config.gap.force_s) ** 2
    return held_rates, held_forces


@njit()
def _repeats(ring: Ring, last: int, axis: int, forces: bool) -> int:
    """Return how many samples up to ``last`` have the reading of the one before them."""
    mask = len(ring) - 1
    first = last
    while first > 0 and last - first < span(ring):
        here, before = ring[first & mask], ring[(first - 1) & mask]
        if forces and here.accel_mps2[axis] != before.accel_mps2[axis]:
            break
        if not forces and here.gyro_radps[axis] != before.gyro_radps[axis]:
            break
        first -= 1
    return last - first


@njit()
def _held_error_s(held_s: float, correlation_s: float) -> float:
    """Return the error of a constant for a signal with correlation time ``correlation_s``.

    Half of the slope times the time squared, and at most all of it.
    """
    return float(min(held_s**2 / (2.0 * correlation_s), held_s))


@njit()
def _line_error_s(dt_s: float, correlation_s: float) -> float:
    """Return the error of a straight line for a signal with correlation time ``correlation_s``.

    A twelfth of the bend times the time cubed, and at most all of it.
    """
    return float(min(dt_s**3 / (12.0 * correlation_s**2), dt_s))


@njit()
def _write_reading_covariances(
    ring: Ring,
    progress: Progress,
    k: int,
    dt_s: float,
    rates: Floats,
    forces: Floats,
    config: EskfConfig,
) -> None:
    """Write the covariances of rate and force, sensor axes, in the strides around, (3, 3) each."""
    first, stop = _samples_around(
        ring, progress, k, dt_s + config.gap.around_s, config.gap.around_s
    )
    mean_mps2 = np.zeros(3)
    mask = len(ring) - 1
    for n in range(first, stop):
        sample = ring[n & mask]
        for i in range(3):
            mean_mps2[i] += sample.accel_mps2[i] / (stop - first)
            for j in range(3):
                rates[i, j] += sample.gyro_radps[i] * sample.gyro_radps[j] / (stop - first)
                forces[i, j] += sample.accel_mps2[i] * sample.accel_mps2[j] / (stop - first)
    for i in range(3):
        for j in range(3):
            forces[i, j] -= mean_mps2[i] * mean_mps2[j]


@njit()
def _samples_around(
    ring: Ring, progress: Progress, k: int, before_s: float, after_s: float
) -> tuple[int, int]:
    """Return the first sample and one past the last that are as near to sample ``k``."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    most = min(progress.measured, reach(ring, k))
    first = k
    while first > 0 and k - first < span(ring):
        if now_s - ring[(first - 1) & mask].t_s > before_s:
            break
        first -= 1
    stop = k + 1
    while stop < most and ring[stop & mask].t_s - now_s <= after_s:
        stop += 1
    return first, stop


@njit()
def _similar_stride_variances(
    ring: Ring, progress: Progress, k: int, dt_s: float
) -> tuple[float, float]:
    """Return the variances, summed over axes, of the similar strides' turns and pushes over the
    gap.
    """
    mask = len(ring) - 1
    periods = lost_periods(ring, k)
    sums = np.zeros((progress.similar_count, 6))
    mean = np.zeros(6)
    for s in range(progress.similar_count):
        at = progress.similar_at[s]
        first, last = ring[at & mask], ring[(at + periods) & mask]
        for n in range(periods + 1):
            sample, late = ring[(at + n) & mask], n / periods
            for i in range(3):
                rate = sample.gyro_radps[i] - _interpolate(
                    first.gyro_radps[i], last.gyro_radps[i], late
                )
                force = sample.accel_mps2[i] - _interpolate(
                    first.accel_mps2[i], last.accel_mps2[i], late
                )
                sums[s, i] += rate * dt_s / periods
                sums[s, 3 + i] += force * dt_s / periods
        for i in range(6):
            mean[i] += progress.similar_weight[s] * sums[s, i]
    turns = 0.0
    pushes = 0.0
    for s in range(progress.similar_count):
        for i in range(3):
            turns += progress.similar_weight[s] * (sums[s, i] - mean[i]) ** 2
            pushes += progress.similar_weight[s] * (sums[s, 3 + i] - mean[3 + i]) ** 2
    return turns, pushes
