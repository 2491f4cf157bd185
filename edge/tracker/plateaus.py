"""Clipping that nobody told: a full scale shows by plateaus.

A rate that hardly changes for a while, and before and after it fell steeply, is no motion of a
foot: about the top of a parabola that stays within a hundredth for n samples the rate has fallen
by less than a tenth n samples further out.  So it is with a force, whose strikes are shorter and
whose rest is no full scale.  Sensors that filter or rotate their readings after
they clipped smooth a plateau, so it need not be the same to the last bit.  What is taken for a
full scale was never passed, and two plateaus agree on it unless one is the same to the last bit,
and of a force falls as steeply: a coarse sensor shows the gentle top of any swing as one value.
Readings that stay the same on all three axes are those of a slow sensor, and count once.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats
from edge.tracker.port import Reason
from edge.tracker.state import Ring, span

GYRO_SATURATED = int(Reason.GYRO_SATURATED)
ACCEL_SATURATED = int(Reason.ACCEL_SATURATED)

BAND = 0.01  # of the reading, within which a plateau stays
LEAST_S = 0.008
LEAST_SAMPLES = 3
LEAST_RADPS = 2.0  # the lowest full scale that is looked for
LEAST_MPS2 = 12.0  # ... and what no accelerometer shows at rest
FLANK = 0.8  # of the plateau; as long before and after it as it lasts, the reading is lower
AGREE = 0.015  # to which two plateaus must
EXACT_RATIO = 0.999  # of a plateau, from which a reading has clipped
SMOOTH_RATIO = 0.985  # the same of one that was smoothed
PASSED = 1.045  # times that: then it was no full scale
MARK_BACK_S = 0.4  # less than the filter's look-ahead

# What is known of the full scale of a sensor of three axes, rad/s or m/s^2.
FULL_SCALE = np.dtype(
    [
        ("forces", np.bool_),  # of an accelerometer
        ("told", np.float64),  # from which a reading has clipped, as described
        ("least", np.float64),
        # By axis.
        ("shown", np.float64, 3),  # from which a reading has clipped, as plateaus show
        ("clip", np.float64, 3),  # the lower of both
        ("floor", np.float64, 3),  # a lower plateau is none, for a reading has passed it
        ("flat", np.float64, 3),  # first of the last readings that hardly differ
        ("flat_samples", np.int64, 3),  # how many
        ("plateau_samples", np.int64, 3),  # the same of a plateau that is yet to be judged
        ("plateau_stop", np.int64, 3),  # one past its last sample
        ("plateau_top", np.float64, 3),  # of the last one that was right
        ("watching", np.bool_),  # a reading was high, or a plateau is yet to be judged
    ]
)


def know_full_scale(known: NDArray[Any], told: float, *, forces: bool) -> None:
    """Fill one record of ``FULL_SCALE``; infinity is ``told`` where nobody did."""
    known["forces"] = forces
    known["least"] = LEAST_MPS2 if forces else LEAST_RADPS
    known["floor"] = known["least"]
    known["told"] = told
    known["clip"] = told
    known["shown"] = np.inf


@njit()
def seek_full_scale(
    ring: Ring, k: int, known: Any, readings: Floats, now_s: float, period_s: float
) -> None:
    """Take the readings (3,) of sample ``k``.

    A full scale shows when a plateau is over, so what has clipped is marked afterwards, as far
    back as no filter has come yet however the samples are batched.
    """
    highest = max(abs(readings[0]), abs(readings[1]), abs(readings[2]))
    if highest < known.least and not known.watching:
        return  # as half of the time
    known.watching = False
    found = False
    for axis in range(3):
        before = known.clip[axis]
        _seek_plateau(ring, k, known, axis, abs(readings[axis]), period_s)
        found = found or known.clip[axis] < before
    if found:
        for axis in range(3):
            _mark_back(ring, k, known, axis, now_s)


@njit()
def _mark_back(ring: Ring, k: int, known: Any, axis: int, now_s: float) -> None:
    mask = len(ring) - 1
    for i in range(k - 1, max(-1, k - span(ring) // 2), -1):
        sample = ring[i & mask]
        if now_s - sample.arrival_s > MARK_BACK_S:
            break
        if _size(sample, axis, known.forces) < known.clip[axis]:
            continue
        if known.forces:
            sample.force_clipped[axis] = 1
            sample.flags |= ACCEL_SATURATED
        else:
            sample.clipped[axis] = 1
            sample.flags |= GYRO_SATURATED


@njit()
def _seek_plateau(ring: Ring, k: int, known: Any, axis: int, size: float, period_s: float) -> None:
    """Take the size of a reading, of sample ``k``; ``clip`` is what plateaus have shown."""
    floor = known.floor[axis]
    if size < floor and known.flat[axis] < floor and known.plateau_samples[axis] == 0:
        return
    known.watching = True
    if size > PASSED * floor:
        known.floor[axis] = size / PASSED
        if size > PASSED * known.shown[axis]:
            _show(known, axis, np.inf)
    samples = known.plateau_samples[axis]
    if samples > 0 and k + 1 >= known.plateau_stop[axis] + samples:
        _judge(ring, known, axis, size, period_s)
        known.plateau_samples[axis] = 0
    if abs(size - known.flat[axis]) <= BAND * known.flat[axis]:
        known.flat_samples[axis] += 1
        return
    samples = known.flat_samples[axis]
    if known.flat[axis] >= known.floor[axis] and _lasts(samples, period_s):
        known.plateau_samples[axis] = samples
        known.plateau_stop[axis] = k
    known.flat[axis] = size
    known.flat_samples[axis] = 1


@njit()
def _lasts(samples: int, period_s: float) -> bool:
    return bool(samples >= LEAST_SAMPLES and samples * period_s >= LEAST_S)


@njit()
def _size(sample: Any, axis: int, forces: bool) -> float:
    return float(abs(sample.accel_mps2[axis] if forces else sample.gyro_radps[axis]))


@njit()
def _is_held(ring: Ring, k: int, forces: bool) -> bool:
    """Whether sample ``k`` repeats the one before on all axes, as those of a slow sensor do."""
    mask = len(ring) - 1
    for axis in range(3):
        if _size(ring[k & mask], axis, forces) != _size(ring[(k - 1) & mask], axis, forces):
            return False
    return True


@njit()
def _show(known: Any, axis: int, shown: float) -> None:
    known.shown[axis] = shown
    known.clip[axis] = min(known.told, shown)


@njit()
def _judge(ring: Ring, known: Any, axis: int, size: float, period_s: float) -> None:
    """Look at the plateau that ended as long ago as it lasted."""
    mask = len(ring) - 1
    samples, stop = known.plateau_samples[axis], known.plateau_stop[axis]
    before = stop - 2 * samples
    if before < 0 or 3 * samples * period_s > MARK_BACK_S:
        return
    top = 0.0
    at_top = 0
    new = 0
    for k in range(stop - samples, stop):
        if _is_held(ring, k, known.forces):
            continue
        new += 1
        here = _size(ring[k & mask], axis, known.forces)
        at_top = at_top + 1 if here == top else 1 if here > top else at_top
        top = max(top, here)
    flank = max(_size(ring[before & mask], axis, known.forces), size)
    falls = flank <= FLANK * top
    if new < LEAST_SAMPLES or top < known.floor[axis] or (known.forces and not falls):
        return
    if _lasts(at_top, period_s):
        for j in range(3):
            _show(known, j, EXACT_RATIO * top)
        return
    if not falls:
        return
    agree = abs(top - known.plateau_top[axis]) <= AGREE * top
    if agree and known.shown[axis] > top:
        _show(known, axis, SMOOTH_RATIO * top)
    known.plateau_top[axis] = top
