"""Search for similar strides: places in the last seconds whose samples are like those around a gap.

People walk in strides that are much alike.  The samples on either side of a gap are compared with
those of the last seconds, and the most similar places are kept, no two of the same stride.  A gap
by a fault of the sensor or of its link can come at any moment of a stride, also at its heel strike;
straight lines across it miss most of what happened.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import SIMILAR_STRIDES, Progress
from edge.tracker.preprocessing.preprocess import BAD_SAMPLES
from edge.tracker.preprocessing.sample_ring import Ring, history, reach, span
from edge.tracker.preprocessing.sample_times import lacks_samples

COMPARED_SAMPLES = 12  # samples on a side that are compared, whatever the rate
SPACING_TOLERANCE = 0.6  # periods by which samples may lie nearer or further where none is missing
STRIDES_MIN = 2  # strides: one alone does not show how similar strides are
SIDE_SAMPLES_MIN = 2  # samples


@njit()
def find_similar_strides(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> None:
    """Write the similar strides for the gap before sample ``k``: none where there is no gap."""
    progress.similar_count = 0
    mask = len(ring) - 1
    dt_s = ring[k & mask].t_s - ring[(k - 1) & mask].t_s
    if k == 0 or not lacks_samples(ring, k & mask, dt_s) or dt_s > config.gap.similar_longest_s:
        return
    side_samples = max(SIDE_SAMPLES_MIN, int(config.gap.similar_side_s / ring[k & mask].period_s))
    before, periods = last_good(ring, k), lost_periods(ring, k)
    if k + side_samples >= min(progress.measured, reach(ring, k)) or before < side_samples:
        return
    if not _are_consecutive(ring, before, side_samples) or not _are_consecutive(
        ring, k + side_samples, side_samples
    ):
        return
    oldest = max(0, k - history(ring), progress.began_at)
    consecutive = 0  # samples in a row from ``n`` on
    for n in range(before, oldest, -1):
        consecutive = consecutive + 1 if _are_consecutive(ring, n, 1) else 0
        if consecutive >= 2 * side_samples + periods:
            _keep_if_similar(ring, progress, k, n + side_samples, side_samples, config)
    if progress.similar_count < STRIDES_MIN:
        progress.similar_count = 0
    weights = 0.0
    for i in range(progress.similar_count):
        progress.similar_weight[i] = 1.0 / (1.0 + progress.similar_distance_m2ps4[i])
        weights += progress.similar_weight[i]
    for i in range(progress.similar_count):
        progress.similar_weight[i] /= weights


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
def _are_consecutive(ring: Ring, last: int, count: int) -> bool:
    """True when the ``count`` samples up to ``last`` follow each other without a gap, and none is
    bad.
    """
    mask = len(ring) - 1
    for n in range(last - count + 1, last + 1):
        here = ring[n & mask]
        off_s = here.t_s - ring[(n - 1) & mask].t_s - here.period_s
        if here.flags & BAD_SAMPLES or abs(off_s) > SPACING_TOLERANCE * here.period_s:
            return False
    return True


@njit()
def _keep_if_similar(
    ring: Ring, progress: Progress, k: int, at: int, side_samples: int, config: EskfConfig
) -> None:
    """Keep ``at``, the last sample before what is like the hole, if it is among the likest."""
    apart = config.gap.similar_apart_s / ring[k & (len(ring) - 1)].period_s
    place = progress.similar_count
    for i in range(progress.similar_count):
        if abs(progress.similar_at[i] - at) < apart:
            place = i  # of the same stride: the liker one is kept
    if place == SIMILAR_STRIDES:
        place = _least_similar(progress)
    is_one_more = place == progress.similar_count
    limit = math.inf if is_one_more else progress.similar_distance_m2ps4[place]
    before, periods = last_good(ring, k), lost_periods(ring, k)
    every = max(1, side_samples // COMPARED_SAMPLES)
    off_m2ps4 = 0.0
    for i in range(0, side_samples, every):
        off_m2ps4 += _distance_m2ps4(ring, at - i, before - i, config)
        off_m2ps4 += _distance_m2ps4(ring, at + periods + i, k + i, config)
        if off_m2ps4 >= limit:
            return
    progress.similar_at[place], progress.similar_distance_m2ps4[place] = at, off_m2ps4
    progress.similar_count += 1 if is_one_more else 0


@njit()
def _least_similar(progress: Progress) -> int:
    worst = 0
    for i in range(1, SIMILAR_STRIDES):
        if progress.similar_distance_m2ps4[i] > progress.similar_distance_m2ps4[worst]:
            worst = i
    return worst


@njit()
def _distance_m2ps4(ring: Ring, a: int, b: int, config: EskfConfig) -> float:
    """Return the squared difference of two samples; the rate counts by its weight."""
    mask = len(ring) - 1
    total = 0.0
    for i in range(3):
        force = ring[a & mask].accel_mps2[i] - ring[b & mask].accel_mps2[i]
        rate = ring[a & mask].gyro_radps[i] - ring[b & mask].gyro_radps[i]
        total += force * force + config.detection.rate_weight_m2ps2 * rate * rate
    return total
