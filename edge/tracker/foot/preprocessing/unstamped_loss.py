"""Samples lost without a trace in the stamps, found by the magnetic field.

Some links drop packets and stamp what arrives by counting it: the stamps are even, and a tenth of a
second of the swing is missing.  A heel strike changes rate and force as suddenly as a loss does,
but the field turns with the foot, evenly.  Where it changes between two samples by more than before
and after, time has passed: as many periods as its change is larger.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import Progress
from edge.tracker.preprocessing.preprocess import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring

LONG_PERIODS = 1.6  # periods from which an interval lacks a sample by its stamps


@njit()
def unstamped_loss_s(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> float:
    """Return how much time is missing between the samples ``k - 1`` and ``k``, mostly none."""
    if k < 3 or k + 2 >= progress.measured:
        return 0.0
    jump_ut = _change_ut(ring, k)
    if not jump_ut > config.loss.field_ut:  # nor where there is no field
        return 0.0
    before_ut, after_ut = _change_ut(ring, k - 1), _change_ut(ring, k + 1)
    if not min(before_ut, after_ut) > config.loss.even_ut:
        return 0.0
    bend_ut = max(_bend_ut(ring, k - 1), _bend_ut(ring, k + 2))
    least_ut = max(config.loss.field_ut, config.loss.bend_ratio * bend_ut)
    is_sudden = jump_ut > config.loss.ratio * max(before_ut, after_ut)
    if not (is_sudden and _unexpected_ut(ring, k) > least_ut and _is_evenly_stamped(ring, k)):
        return 0.0
    lost_periods = jump_ut / (0.5 * (before_ut + after_ut)) - 1.0
    period_s: float = ring[k & (len(ring) - 1)].period_s
    return min(lost_periods * period_s, config.loss.longest_s)


@njit()
def _is_evenly_stamped(ring: Ring, k: int) -> bool:
    """True where the samples around are good and their stamps show no loss."""
    mask = len(ring) - 1
    for n in range(k - 1, k + 2):
        here = ring[n & mask]
        interval_s = here.t_s - ring[(n - 1) & mask].t_s
        if here.flags & (BAD_SAMPLES | SAMPLE_GAP) or interval_s > LONG_PERIODS * here.period_s:
            return False
    return True


@njit()
def _change_ut(ring: Ring, k: int) -> float:
    """Return the norm of the field's change from sample ``k - 1`` to ``k``; NaN without a field."""
    mask = len(ring) - 1
    after, before = ring[k & mask].mag_ut, ring[(k - 1) & mask].mag_ut
    return _norm(after[0] - before[0], after[1] - before[1], after[2] - before[2])


@njit()
def _bend_ut(ring: Ring, k: int) -> float:
    """Return how much the change to sample ``k`` differs from the one before it."""
    mask = len(ring) - 1
    a, b, c = ring[(k - 2) & mask].mag_ut, ring[(k - 1) & mask].mag_ut, ring[k & mask].mag_ut
    return _norm(c[0] - 2.0 * b[0] + a[0], c[1] - 2.0 * b[1] + a[1], c[2] - 2.0 * b[2] + a[2])


@njit()
def _unexpected_ut(ring: Ring, k: int) -> float:
    """Return by how much the change to ``k`` is off the mean of those before and after."""
    mask = len(ring) - 1
    a, b = ring[(k - 2) & mask].mag_ut, ring[(k - 1) & mask].mag_ut
    c, d = ring[k & mask].mag_ut, ring[(k + 1) & mask].mag_ut
    return _norm(
        1.5 * (c[0] - b[0]) - 0.5 * (d[0] - a[0]),
        1.5 * (c[1] - b[1]) - 0.5 * (d[1] - a[1]),
        1.5 * (c[2] - b[2]) - 0.5 * (d[2] - a[2]),
    )


@njit()
def _norm(x: float, y: float, z: float) -> float:
    return math.sqrt(x * x + y * y + z * z)
