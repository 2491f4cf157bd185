"""Times of samples: without the delay of a late delivery, and the gaps between them."""

from __future__ import annotations

from numba import njit

from edge.tracker.preprocessing.preprocess import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring

CUBIC_MAX_PERIODS = 3.5  # periods; what more than two missing samples hid is no cubic


@njit()
def regular_time(ring: Ring, k: int, stop: int, late_s: float) -> float:
    """Return the time of sample ``k`` without late delivery, in s since the first sample.

    A stamp may be late (polled or quantised transport) but not early, so samples
    that follow on time, counted back by the mean period, bound when ``k`` was taken.
    """
    mask = len(ring) - 1
    arrival_s = ring[k & mask].arrival_s
    period_s = ring[k & mask].period_s
    best_s = arrival_s
    back_s = 0.0
    for j in range(k + 1, stop):
        slot = j & mask
        if ring[slot].arrival_s - arrival_s > late_s:
            break
        if ring[slot].flags & (BAD_SAMPLES | SAMPLE_GAP) == 0:
            back_s += period_s
            best_s = min(best_s, ring[slot].arrival_s - back_s)
    if k > 0:
        best_s = max(best_s, ring[(k - 1) & mask].t_s)
    return float(best_s)


@njit()
def lacks_samples(ring: Ring, slot: int, dt_s: float) -> bool:
    """True when so many samples are missing before the one in ``slot`` that no cubic spans them."""
    return bool(dt_s > CUBIC_MAX_PERIODS * ring[slot].period_s)
