"""Detection of an undeclared full scale from plateaus of the readings.

A rate that hardly changes for a while, and before and after it fell steeply, is no motion of a
foot: about the top of a parabola that stays within a hundredth for n samples the rate has fallen by
less than a tenth n samples further out.  The same holds for a force, whose strikes are shorter and
whose rest is no full scale.  Sensors that filter or rotate their readings after saturation smooth a
plateau, so it need not be equal to the last bit.

A value that is taken for a full scale was never exceeded, and two plateaus agree on it.  One
plateau is enough if it is equal to the last bit, and of a force also falls as steeply: a coarse
sensor shows the gentle top of any swing as one value.  Readings that stay equal on all three axes
are those of a slow sensor, and count once.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats
from edge.tracker.interface import Reason
from edge.tracker.preprocessing.sample_ring import Ring, span

GYRO_SATURATED = int(Reason.GYRO_SATURATED)
ACCEL_SATURATED = int(Reason.ACCEL_SATURATED)

BAND = 0.01  # of the reading, within which a plateau stays
PLATEAU_MIN_S = 0.008
PLATEAU_MIN_SAMPLES = 3
RATE_MIN_RADPS = 2.0  # the lowest full scale that is looked for
FORCE_MIN_MPS2 = 12.0  # ... and what no accelerometer shows at rest
FLANK = 0.8  # of the plateau; as long before and after it as it lasts, the reading is lower
AGREEMENT = 0.015  # to which two plateaus must
EXACT_RATIO = 0.999  # of a plateau, from which a reading has clipped
SMOOTH_RATIO = 0.985  # the same of one that was smoothed
EXCEEDED_RATIO = 1.045  # times that: then it was no full scale
MARK_BACK_S = 0.4  # less than the filter's look-ahead

# What is known of the full scale of a sensor of three axes, rad/s or m/s^2.
FULL_SCALE = np.dtype(
    [
        ("forces", np.bool_),  # of an accelerometer
        ("declared", np.float64),  # from which a reading has clipped, as described
        ("least", np.float64),
        # By axis.
        ("detected", np.float64, 3),  # from which a reading has clipped, as plateaus show
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


def set_declared_range(full_scale: NDArray[Any], declared: float, *, forces: bool) -> None:
    """Fill one record of ``FULL_SCALE``; ``declared`` is infinite where no range is known."""
    full_scale["forces"] = forces
    full_scale["least"] = FORCE_MIN_MPS2 if forces else RATE_MIN_RADPS
    full_scale["floor"] = full_scale["least"]
    full_scale["declared"] = declared
    full_scale["clip"] = declared
    full_scale["detected"] = np.inf


@njit()
def detect_full_scale(
    ring: Ring, k: int, full_scale: Any, readings: Floats, now_s: float, period_s: float
) -> None:
    """Take the readings (3,) of sample ``k``.

    A full scale shows when a plateau is over, so what has clipped is marked afterwards, as far
    back as no filter has come yet however the samples are batched.
    """
    highest = max(abs(readings[0]), abs(readings[1]), abs(readings[2]))
    if highest < full_scale.least and not full_scale.watching:
        return  # as half of the time
    full_scale.watching = False
    found = False
    for axis in range(3):
        before = full_scale.clip[axis]
        _detect_plateau(ring, k, full_scale, axis, abs(readings[axis]), period_s)
        found = found or full_scale.clip[axis] < before
    if found:
        for axis in range(3):
            _mark_earlier_samples(ring, k, full_scale, axis, now_s)


@njit()
def _mark_earlier_samples(ring: Ring, k: int, full_scale: Any, axis: int, now_s: float) -> None:
    mask = len(ring) - 1
    for i in range(k - 1, max(-1, k - span(ring) // 2), -1):
        sample = ring[i & mask]
        if now_s - sample.arrival_s > MARK_BACK_S:
            break
        if _size(sample, axis, full_scale.forces) < full_scale.clip[axis]:
            continue
        if full_scale.forces:
            sample.force_saturated[axis] = 1
            sample.flags |= ACCEL_SATURATED
        else:
            sample.rate_saturated[axis] = 1
            sample.flags |= GYRO_SATURATED


@njit()
def _detect_plateau(
    ring: Ring, k: int, full_scale: Any, axis: int, size: float, period_s: float
) -> None:
    """Take the size of a reading, of sample ``k``; ``clip`` is what plateaus have shown."""
    floor = full_scale.floor[axis]
    if size < floor and full_scale.flat[axis] < floor and full_scale.plateau_samples[axis] == 0:
        return
    full_scale.watching = True
    if size > EXCEEDED_RATIO * floor:
        full_scale.floor[axis] = size / EXCEEDED_RATIO
        if size > EXCEEDED_RATIO * full_scale.detected[axis]:
            _set_detected(full_scale, axis, np.inf)
    samples = full_scale.plateau_samples[axis]
    if samples > 0 and k + 1 >= full_scale.plateau_stop[axis] + samples:
        _evaluate_plateau(ring, full_scale, axis, size, period_s)
        full_scale.plateau_samples[axis] = 0
    if abs(size - full_scale.flat[axis]) <= BAND * full_scale.flat[axis]:
        full_scale.flat_samples[axis] += 1
        return
    samples = full_scale.flat_samples[axis]
    if full_scale.flat[axis] >= full_scale.floor[axis] and _lasts(samples, period_s):
        full_scale.plateau_samples[axis] = samples
        full_scale.plateau_stop[axis] = k
    full_scale.flat[axis] = size
    full_scale.flat_samples[axis] = 1


@njit()
def _lasts(samples: int, period_s: float) -> bool:
    return bool(samples >= PLATEAU_MIN_SAMPLES and samples * period_s >= PLATEAU_MIN_S)


@njit()
def _size(sample: Any, axis: int, forces: bool) -> float:
    return float(abs(sample.accel_mps2[axis] if forces else sample.gyro_radps[axis]))


@njit()
def _is_repeated(ring: Ring, k: int, forces: bool) -> bool:
    """True when sample ``k`` repeats the one before on all axes, as those of a slow sensor do."""
    mask = len(ring) - 1
    for axis in range(3):
        if _size(ring[k & mask], axis, forces) != _size(ring[(k - 1) & mask], axis, forces):
            return False
    return True


@njit()
def _set_detected(full_scale: Any, axis: int, detected: float) -> None:
    full_scale.detected[axis] = detected
    full_scale.clip[axis] = min(full_scale.declared, detected)


@njit()
def _evaluate_plateau(ring: Ring, full_scale: Any, axis: int, size: float, period_s: float) -> None:
    """Look at the plateau that ended as long ago as it lasted."""
    mask = len(ring) - 1
    samples, stop = full_scale.plateau_samples[axis], full_scale.plateau_stop[axis]
    before = stop - 2 * samples
    if before < 0 or 3 * samples * period_s > MARK_BACK_S:
        return
    top = 0.0
    at_top = 0
    new = 0
    for k in range(stop - samples, stop):
        if _is_repeated(ring, k, full_scale.forces):
            continue
        new += 1
        reading = _size(ring[k & mask], axis, full_scale.forces)
        at_top = at_top + 1 if reading == top else 1 if reading > top else at_top
        top = max(top, reading)
    flank = max(_size(ring[before & mask], axis, full_scale.forces), size)
    falls = flank <= FLANK * top
    if (
        new < PLATEAU_MIN_SAMPLES
        or top < full_scale.floor[axis]
        or (full_scale.forces and not falls)
    ):
        return
    if _lasts(at_top, period_s):
        for j in range(3):
            _set_detected(full_scale, j, EXACT_RATIO * top)
        return
    if not falls:
        return
    matches = abs(top - full_scale.plateau_top[axis]) <= AGREEMENT * top
    if matches and full_scale.detected[axis] > top:
        _set_detected(full_scale, axis, SMOOTH_RATIO * top)
    full_scale.plateau_top[axis] = top
