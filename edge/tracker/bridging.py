"""Across a hole in the samples that is shorter than a stride.

Where one or two samples are missing the cubic through those around goes on (see intervals).  Over a
longer hole it goes on as in the strides that were likest there (see like_strides): by the mean of
their readings, bent so that they meet those at both ends.  By recorded walks that is off as by
noise, about and along all axes alike, and the more the more those strides differ.

Where there are no such strides, rate and force are taken for straight lines from one end to the
other, and doubted by what they vary by in the strides around, about and along the same axes: what
a line misses of a swing is mostly a turn about the axis on which a foot rolls, which the next
stance puts right.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE, POSITION, VELOCITY
from edge.tracker.intervals import accel_scale, go_on
from edge.tracker.like_strides import last_good, lost_periods
from edge.tracker.state import FilterState, Progress, Ring, reach, span


@njit()
def walk_on(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Move the state over the hole before sample ``k`` as it went on in the like strides.

    Leaves the means over the hole as if it were an interval.
    """
    periods = lost_periods(ring, k)
    scale = accel_scale(ring[k & (len(ring) - 1)].rest_norm_mps2, config)
    state.hole_means[:] = 0.0
    for n in range(periods):
        _write_readings(ring, progress, state, k, n)
        for i in range(3):
            state.gyro_radps[i] -= state.gyro_bias_radps[i]
            state.accel_mps2[i] = scale * state.accel_mps2[i] - state.accel_bias_mps2[i]
        go_on(state, dt_s / periods, config)
        for i in range(3):
            state.hole_means[0, i] += state.gyro_radps[i] / periods
            state.hole_means[1, i] += state.accel_mps2[i] / periods
            state.hole_means[2, i] += state.force_n_mps2[i] / periods
    for i in range(3):
        state.gyro_radps[i] = state.hole_means[0, i]
        state.accel_mps2[i] = state.hole_means[1, i]
        state.force_n_mps2[i] = state.hole_means[2, i]


@njit()
def _write_readings(ring: Ring, progress: Progress, state: FilterState, k: int, n: int) -> None:
    """Write the mean readings of period ``n`` of the hole before ``k``, as the sensor has them."""
    mask = len(ring) - 1
    periods = lost_periods(ring, k)
    start, end = ring[last_good(ring, k) & mask], ring[k & mask]
    late = (n + 0.5) / periods
    for i in range(3):
        state.gyro_radps[i] = _line(start.gyro_radps[i], end.gyro_radps[i], late)
        state.accel_mps2[i] = _line(start.accel_mps2[i], end.accel_mps2[i], late)
    for s in range(progress.like_count):
        at, weight = progress.like_at[s], progress.like_weight[s]
        first, last = ring[at & mask], ring[(at + periods) & mask]
        a, b = ring[(at + n) & mask], ring[(at + n + 1) & mask]
        for i in range(3):
            rate = 0.5 * (a.gyro_radps[i] + b.gyro_radps[i])
            rate -= _line(first.gyro_radps[i], last.gyro_radps[i], late)
            state.gyro_radps[i] += weight * rate
            force = 0.5 * (a.accel_mps2[i] + b.accel_mps2[i])
            force -= _line(first.accel_mps2[i], last.accel_mps2[i], late)
            state.accel_mps2[i] += weight * force


@njit()
def _line(first: float, last: float, late: float) -> float:
    return (1.0 - late) * first + late * last


@njit()
def doubt_hole(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Widen the covariance by what may have been missed in the hole before sample ``k``."""
    rates, forces = np.zeros((3, 3)), np.zeros((3, 3))
    _vary(ring, progress, k, dt_s, rates, forces, config)
    noise_s2 = dt_s**3 / config.like_rate_s, dt_s**3 / config.like_force_s
    if progress.like_count:
        turns, pushes = _differ(ring, progress, k, dt_s)
        turn_var = np.trace(rates) * noise_s2[0] + config.like_differing * turns
        push_var = np.trace(forces) * noise_s2[1] + config.like_differing * pushes
        rates, forces = np.eye(3) * turn_var / 3.0, np.eye(3) * push_var / 3.0
    else:  # a line is no better than a like stride
        rates *= max(noise_s2[0], _bend_s(dt_s, config.gap_rate_s) ** 2)
        forces *= max(noise_s2[1], _bend_s(dt_s, config.gap_force_s) ** 2)
    rotation = state.rotation_nb
    turned, pushed = rotation @ rates @ rotation.T, rotation @ forces @ rotation.T
    p = state.covariance
    for i in range(3):
        for j in range(3):
            p[ATTITUDE + i, ATTITUDE + j] += turned[i, j]
            p[VELOCITY + i, VELOCITY + j] += pushed[i, j]
            p[POSITION + i, VELOCITY + j] += pushed[i, j] * dt_s / 2.0
            p[VELOCITY + i, POSITION + j] += pushed[i, j] * dt_s / 2.0
            p[POSITION + i, POSITION + j] += pushed[i, j] * dt_s**2 / 3.0


@njit()
def _bend_s(dt_s: float, keeps_s: float) -> float:
    """Return by how much a straight line is off, of what goes its way for ``keeps_s``.

    A twelfth of the bend times the time cubed, and at most all of it.
    """
    return float(min(dt_s**3 / (12.0 * keeps_s**2), dt_s))


@njit()
def _vary(
    ring: Ring,
    progress: Progress,
    k: int,
    dt_s: float,
    rates: Floats,
    forces: Floats,
    config: EskfConfig,
) -> None:
    """Write what rate and force, sensor axes, vary by in the strides around, (3, 3) each."""
    first, stop = _around(ring, progress, k, dt_s + config.gap_around_s, config.gap_around_s)
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
def _around(
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
def _differ(ring: Ring, progress: Progress, k: int, dt_s: float) -> tuple[float, float]:
    """Return the variances, of all axes, of the like strides' turns and pushes over the hole."""
    mask = len(ring) - 1
    periods = lost_periods(ring, k)
    sums = np.zeros((progress.like_count, 6))
    mean = np.zeros(6)
    for s in range(progress.like_count):
        at = progress.like_at[s]
        first, last = ring[at & mask], ring[(at + periods) & mask]
        for n in range(periods + 1):
            sample, late = ring[(at + n) & mask], n / periods
            for i in range(3):
                rate = sample.gyro_radps[i] - _line(first.gyro_radps[i], last.gyro_radps[i], late)
                force = sample.accel_mps2[i] - _line(first.accel_mps2[i], last.accel_mps2[i], late)
                sums[s, i] += rate * dt_s / periods
                sums[s, 3 + i] += force * dt_s / periods
        for i in range(6):
            mean[i] += progress.like_weight[s] * sums[s, i]
    turns = 0.0
    pushes = 0.0
    for s in range(progress.like_count):
        for i in range(3):
            turns += progress.like_weight[s] * (sums[s, i] - mean[i]) ** 2
            pushes += progress.like_weight[s] * (sums[s, 3 + i] - mean[3 + i]) ** 2
    return turns, pushes
