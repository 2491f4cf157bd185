"""Stance detector: a stillness statistic and a threshold that follows each stride.

The statistic is SHOE's (Skog et al., "Zero-velocity detection: an algorithm evaluation", 2010) in
m^2/s^4, over a short window: ``T = var(f) + w mean(|rate|^2) + (|mean f| - g0)^2``.  Shoes, gaits
and sensors differ by orders of magnitude in how still the stillest instant of a stride is, so the
threshold is a multiple of the least statistic in the surrounding stride, within bounds.  ``g0``,
what the accelerometer shows at rest, is learned: real ones show 9.5 to 10.6 m/s^2.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import FilterState, Progress, Window
from edge.tracker.mechanization.strapdown import dot
from edge.tracker.preprocessing.sample_ring import Ring, reach, span


@njit()
def measure_motion(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> None:
    """Write the statistic of sample ``k``, and their sum up to it."""
    mask = len(ring) - 1
    here, before = k & mask, (k - 1) & mask
    ring[here].motion_m2ps4 = motion_statistic(ring, progress, k, config)
    ring[here].rest_norm_mps2 = progress.rest_norm_mps2
    ring[here].motion_sum_m2ps4 = ring[before].motion_sum_m2ps4 + ring[here].motion_m2ps4


@njit()
def add_readings(ring: Ring, k: int) -> None:
    """Write the sums of readings up to sample ``k``, whose differences are those of a window.

    After a day at 200 Hz a square of the force is rounded by 1e-7 m^2/s^4.
    """
    here, before = ring[k & (len(ring) - 1)], ring[(k - 1) & (len(ring) - 1)]
    for i in range(3):
        here.force_sum_mps2[i] = before.force_sum_mps2[i] + here.accel_mps2[i]
        here.rate_sum_radps[i] = before.rate_sum_radps[i] + here.gyro_radps[i]
    here.force_square_sum_m2ps4 = before.force_square_sum_m2ps4 + dot(
        here.accel_mps2, here.accel_mps2
    )
    here.rate_square_sum_rad2ps2 = before.rate_square_sum_rad2ps2 + dot(
        here.gyro_radps, here.gyro_radps
    )


@njit()
def _move_window(ring: Ring, window: Window, k: int, stop: int, half_s: float) -> None:
    """Move ``window`` on to the samples within ``half_s`` of ``k`` and before ``stop``."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    first, last = max(window.first, k - span(ring)), max(window.last, k)
    while now_s - ring[first & mask].t_s > half_s:
        first += 1
    while last + 1 < stop and ring[(last + 1) & mask].t_s - now_s <= half_s:
        last += 1
    window.first, window.last = first, last


@njit()
def motion_statistic(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> float:
    """Return the statistic of sample ``k``."""
    mask = len(ring) - 1
    window = progress.motion_window
    stop = min(progress.timed, reach(ring, k))
    _move_window(ring, window, k, stop, config.detection.half_window_s)
    count = window.last + 1 - window.first
    to, before = ring[window.last & mask], ring[(window.first - 1) & mask]
    squares = to.force_square_sum_m2ps4 - before.force_square_sum_m2ps4
    rates = to.rate_square_sum_rad2ps2 - before.rate_square_sum_rad2ps2
    square_of_sum = 0.0
    steady = 0.0
    for i in range(3):
        force = to.force_sum_mps2[i] - before.force_sum_mps2[i]
        rate = to.rate_sum_radps[i] - before.rate_sum_radps[i]
        square_of_sum += force * force
        steady += rate * rate
    steady /= count * count
    mean_norm = math.sqrt(square_of_sum) / count
    agitation = max(squares / count - mean_norm * mean_norm, 0.0)
    agitation += config.detection.rate_weight_m2ps2 * max(rates, 0.0) / count
    off_mps2 = mean_norm - progress.rest_norm_mps2
    unsteady = agitation - config.detection.rate_weight_m2ps2 * steady
    if (
        unsteady < config.detection.rest_motion_m2ps4
        and steady < config.detection.rest_rate_radps**2
        and abs(off_mps2) < config.detection.rest_off_mps2
    ):
        progress.rest_norm_mps2 += config.detection.rest_weight * off_mps2
    return float(agitation + off_mps2 * off_mps2)


@njit()
def stride_minimum(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> float:
    """Return the smallest statistic from ``stride_past_s`` before to ``lookahead_s`` after ``k``.

    At the start, and after a long hole, it looks further ahead instead: samples may begin in
    mid-swing, and half a swing is no stride.  Called for every ``k`` in turn; ``progress`` keeps
    the sliding window.
    """
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    at = progress.minimum_at
    to = progress.minimum_to
    stop = min(progress.measured, reach(ring, k))
    ahead_s = config.timing.lookahead_s
    since_s = now_s - progress.began_s
    if (
        since_s < config.timing.lag_s
    ):  # nothing came before; the first sample has waited for the lag too
        ahead_s += config.timing.lag_s - since_s
        stop = min(stop, reach(ring, progress.began_at))
    while to < stop and ring[to & mask].t_s - now_s <= ahead_s:
        if to == 0 or ring[to & mask].motion_m2ps4 <= ring[at & mask].motion_m2ps4:
            at = to
        to += 1
    begin = max(progress.minimum_from, to - mask)
    while now_s - ring[begin & mask].t_s > config.detection.stride_past_s:
        begin += 1
    if at < begin:
        at = begin
        for i in range(begin, to):
            if ring[i & mask].motion_m2ps4 <= ring[at & mask].motion_m2ps4:
                at = i
    progress.minimum_at = at
    progress.minimum_from = begin
    progress.minimum_to = to
    return float(ring[at & mask].motion_m2ps4)


@njit()
def unrest(ring: Ring, progress: Progress, state: FilterState, k: int, config: EskfConfig) -> float:
    """Return the mean statistic within ``unrest_half_window_s`` of ``k``, free of bias.

    ``rest_rate_radps`` becomes the mean rate, ``rest_rate_var_rad2ps2`` its scatter.

    Sway cannot be separated from a gyroscope's bias sample by sample: judged one by one, the
    samples whose sway happens to cancel the bias would pass for the stillest.  So the rate
    counts as far as its mean is off the bias that is known.
    """
    mask = len(ring) - 1
    window = progress.unrest_window
    stop = min(progress.measured, reach(ring, k))
    _move_window(ring, window, k, stop, config.zupt.unrest_half_window_s)
    count = window.last + 1 - window.first
    to, before = ring[window.last & mask], ring[(window.first - 1) & mask]
    total = to.motion_sum_m2ps4 - before.motion_sum_m2ps4
    by_bias = 0.0  # of the mean square rate
    squares = to.rate_square_sum_rad2ps2 - before.rate_square_sum_rad2ps2
    state.rest_rate_var_rad2ps2 = squares / count
    for i in range(3):
        mean = (to.rate_sum_radps[i] - before.rate_sum_radps[i]) / count
        off = mean - state.gyro_bias_radps[i]
        by_bias += mean * mean - off * off
        state.rest_rate_radps[i] = mean
        state.rest_rate_var_rad2ps2 -= mean * mean
    return float(max(total / count - config.detection.rate_weight_m2ps2 * by_bias, 0.0))


@njit()
def steady_rate(ring: Ring, first: int, stop: int, ahead_s: float, config: EskfConfig) -> Floats:
    """Return the mean rate (3,) at rest from sample ``first`` on, zeros in motion.

    Looks at samples before ``stop`` and at most ``ahead_s`` after ``first``.  Neither a bias of
    the gyroscope nor a scale of the accelerometer counts as motion.
    """
    mask = len(ring) - 1
    while stop > first + 1 and ring[(stop - 1) & mask].t_s - ring[first & mask].t_s > ahead_s:
        stop -= 1
    count = stop - first
    rate_radps = np.zeros(3)
    force_mps2 = np.zeros(3)
    squares = 0.0
    for k in range(first, stop):
        for i in range(3):
            rate, force = ring[k & mask].gyro_radps[i], ring[k & mask].accel_mps2[i]
            rate_radps[i] += rate / count
            force_mps2[i] += force / count
            squares += (force * force + config.detection.rate_weight_m2ps2 * rate * rate) / count
    squares -= (force_mps2**2).sum() + config.detection.rate_weight_m2ps2 * (rate_radps**2).sum()
    if squares > config.detection.steady_motion_m2ps4:
        rate_radps[:] = 0.0
    return rate_radps


@njit()
def stance_threshold(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> float:
    """Return the statistic up to which a sample counts as standing.

    A lift pushes like a small step.  Where a barometer shows the ride, the person stands.
    """
    threshold = config.detection.threshold_ratio * ring[slot].stride_minimum_m2ps4
    least = config.detection.threshold_min_m2ps4
    since_change_s = ring[slot].t_s - state.barometer.changed_s
    if state.barometer.started and since_change_s < config.air.ride_longest_s:
        least = config.air.ride_motion_m2ps4
    return float(min(max(threshold, least), config.detection.threshold_max_m2ps4))
