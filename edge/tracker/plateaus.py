"""Clipping that nobody told: a full scale shows by plateaus.

A rate that hardly changes for a while, and before and after it fell steeply, is no motion of a
foot: about the top of a parabola that stays within a hundredth for n samples the rate has fallen
by less than a tenth n samples further out.  Sensors that filter or rotate their readings after
they clipped smooth a plateau, so it need not be the same to the last bit.  What is taken for a
full scale was never passed, and two plateaus agree on it unless one is the same to the last bit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.tracker.state import Ring

BAND = 0.01  # of the rate, within which a plateau stays
LEAST_S = 0.008
LEAST_SAMPLES = 3
LEAST_RADPS = 2.0  # the lowest full scale that is looked for
FLANK = 0.8  # of the plateau; as long before and after it as it lasts, the rate is lower
AGREE = 0.015  # to which two plateaus must
EXACT_RATIO = 0.999  # of a plateau, from which a rate has clipped
SMOOTH_RATIO = 0.985  # the same of one that was smoothed
PASSED = 1.045  # times that: then it was no full scale


@njit()
def seek_plateau(ring: Ring, k: int, gate: NDArray[Any], axis: int, rate_radps: float) -> None:
    """Take the size of a rate, of sample ``k``; ``clip_radps`` is what plateaus have shown."""
    g = gate[0]
    slow = rate_radps < LEAST_RADPS and g.flat_radps[axis] < LEAST_RADPS
    if slow and g.plateau_samples[axis] == 0:
        return
    g.watching = True
    if rate_radps > g.highest_radps[axis]:
        g.highest_radps[axis] = rate_radps
        if rate_radps > PASSED * g.clip_radps[axis]:
            g.clip_radps[axis] = np.inf
    if g.plateau_samples[axis] > 0 and k + 1 >= g.plateau_stop[axis] + g.plateau_samples[axis]:
        _judge(ring, gate, axis, rate_radps)
        g.plateau_samples[axis] = 0
    if abs(rate_radps - g.flat_radps[axis]) <= BAND * g.flat_radps[axis]:
        g.flat_samples[axis] += 1
        return
    samples = g.flat_samples[axis]
    high = (
        g.flat_radps[axis] >= LEAST_RADPS and g.flat_radps[axis] * PASSED >= g.highest_radps[axis]
    )
    if high and _lasts(gate, samples):
        g.plateau_samples[axis] = samples
        g.plateau_stop[axis] = k
    g.flat_radps[axis] = rate_radps
    g.flat_samples[axis] = 1


@njit()
def _lasts(gate: NDArray[Any], samples: int) -> bool:
    return bool(samples >= LEAST_SAMPLES and samples * gate[0].period_s >= LEAST_S)


@njit()
def _judge(ring: Ring, gate: NDArray[Any], axis: int, rate_radps: float) -> None:
    """Look at the plateau that ended as long ago as it lasted."""
    g = gate[0]
    mask = len(ring) - 1
    samples, stop = g.plateau_samples[axis], g.plateau_stop[axis]
    before = stop - 2 * samples
    if before < 0 or samples > mask // 8:
        return
    top_radps = 0.0
    at_top = 0
    for k in range(stop - samples, stop):
        radps = abs(ring[k & mask].gyro_radps[axis])
        at_top = at_top + 1 if radps == top_radps else 1 if radps > top_radps else at_top
        top_radps = max(top_radps, radps)
    if top_radps * PASSED < g.highest_radps[axis]:
        return
    if _lasts(gate, at_top):
        for j in range(3):
            g.clip_radps[j] = EXACT_RATIO * top_radps
        return
    flank_radps = max(abs(ring[before & mask].gyro_radps[axis]), rate_radps)
    if flank_radps > FLANK * top_radps:
        return
    agree = abs(top_radps - g.plateau_radps[axis]) <= AGREE * top_radps
    if agree and g.clip_radps[axis] > top_radps:
        g.clip_radps[axis] = SMOOTH_RATIO * top_radps
    g.plateau_radps[axis] = top_radps
