"""Strides in which it went on as in a hole of the samples, for all that is known of it.

People walk in strides that are much alike.  The samples on either side of a hole are sought among
those of the last seconds, and the likest places are kept, no two of them of the same stride.  A
hole by a fault of the sensor or of its link can come at any moment of a stride, also at its heel
strike; straight lines over it miss most of what happened.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.conditioning import BAD_SAMPLES
from edge.tracker.config import EskfConfig
from edge.tracker.intervals import lacks_samples
from edge.tracker.state import LIKE_STRIDES, Progress, Ring, history, reach, span

LOOKS = 12  # samples on a side that are compared, whatever the rate
EVEN = 0.6  # periods by which samples may lie nearer or further where none is missing
LEAST = 2  # strides: of one alone nobody knows how alike strides are
LEAST_SIDE = 2  # samples


@njit()
def seek_like_strides(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> None:
    """Write which they are for the hole before sample ``k``: none where there is no hole."""
    progress.like_count = 0
    mask = len(ring) - 1
    dt_s = ring[k & mask].t_s - ring[(k - 1) & mask].t_s
    if k == 0 or not lacks_samples(ring, k & mask, dt_s) or dt_s > config.like_longest_s:
        return
    wide = max(LEAST_SIDE, int(config.like_side_s / ring[k & mask].period_s))
    before, periods = last_good(ring, k), lost_periods(ring, k)
    if k + wide >= min(progress.measured, reach(ring, k)) or before < wide:
        return
    if not _are_whole(ring, before, wide) or not _are_whole(ring, k + wide, wide):
        return
    oldest = max(0, k - history(ring), progress.began_at)
    whole = 0  # samples in a row from ``n`` on
    for n in range(before, oldest, -1):
        whole = whole + 1 if _are_whole(ring, n, 1) else 0
        if whole >= 2 * wide + periods:
            _consider(ring, progress, k, n + wide, wide, config)
    if progress.like_count < LEAST:
        progress.like_count = 0
    weights = 0.0
    for i in range(progress.like_count):
        progress.like_weight[i] = 1.0 / (1.0 + progress.like_off_m2ps4[i])
        weights += progress.like_weight[i]
    for i in range(progress.like_count):
        progress.like_weight[i] /= weights


@njit()
def lost_periods(ring: Ring, k: int) -> int:
    """Return how many periods the hole before sample ``k`` lasts."""
    mask = len(ring) - 1
    periods: int = round((ring[k & mask].t_s - ring[(k - 1) & mask].t_s) / ring[k & mask].period_s)
    return periods


@njit()
def last_good(ring: Ring, k: int) -> int:
    """Return the last sample before ``k`` that is not bad, as far as is looked back."""
    mask = len(ring) - 1
    before = k - 1
    while before > 0 and k - before < span(ring) and ring[before & mask].flags & BAD_SAMPLES:
        before -= 1
    return before


@njit()
def _are_whole(ring: Ring, last: int, count: int) -> bool:
    """Whether the ``count`` samples up to ``last`` each follow the one before, and none is bad."""
    mask = len(ring) - 1
    for n in range(last - count + 1, last + 1):
        here = ring[n & mask]
        off_s = here.t_s - ring[(n - 1) & mask].t_s - here.period_s
        if here.flags & BAD_SAMPLES or abs(off_s) > EVEN * here.period_s:
            return False
    return True


@njit()
def _consider(
    ring: Ring, progress: Progress, k: int, at: int, wide: int, config: EskfConfig
) -> None:
    """Keep ``at``, the last sample before what is like the hole, if it is among the likest."""
    apart = config.like_apart_s / ring[k & (len(ring) - 1)].period_s
    place = progress.like_count
    for i in range(progress.like_count):
        if abs(progress.like_at[i] - at) < apart:
            place = i  # of the same stride: the liker one is kept
    if place == LIKE_STRIDES:
        place = _least_like(progress)
    is_one_more = place == progress.like_count
    limit = math.inf if is_one_more else progress.like_off_m2ps4[place]
    before, periods = last_good(ring, k), lost_periods(ring, k)
    every = max(1, wide // LOOKS)
    off_m2ps4 = 0.0
    for i in range(0, wide, every):
        off_m2ps4 += _off_m2ps4(ring, at - i, before - i, config)
        off_m2ps4 += _off_m2ps4(ring, at + periods + i, k + i, config)
        if off_m2ps4 >= limit:
            return
    progress.like_at[place], progress.like_off_m2ps4[place] = at, off_m2ps4
    progress.like_count += 1 if is_one_more else 0


@njit()
def _least_like(progress: Progress) -> int:
    worst = 0
    for i in range(1, LIKE_STRIDES):
        if progress.like_off_m2ps4[i] > progress.like_off_m2ps4[worst]:
            worst = i
    return worst


@njit()
def _off_m2ps4(ring: Ring, a: int, b: int, config: EskfConfig) -> float:
    """Return how far two samples are apart, squared, the rate by its weight."""
    mask = len(ring) - 1
    total = 0.0
    for i in range(3):
        force = ring[a & mask].accel_mps2[i] - ring[b & mask].accel_mps2[i]
        rate = ring[a & mask].gyro_radps[i] - ring[b & mask].gyro_radps[i]
        total += force * force + config.rate_weight_m2ps2 * rate * rate
    return total
