"""Monitor of lasting faults of an inertial sensor.  The tracker handles single bad samples: it
leaves them out and names them in the position's reasons.

Each batch is examined as a whole: a recording that is tracked again has a second of samples in
each, an agent some hundredths.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S
from shared.coded_text import coded

_LASTING_NS = NS_PER_S
_TURNING_RADPS = 0.5  # change of the gyroscope in a swing, at least
_SHAKING_MPS2 = 2.0  # change of the accelerometer in a swing, at least
_MOVED_NS = NS_PER_S // 5  # a swing or two
_LONGEST_STEP_NS = NS_PER_S // 10  # motion in a longer gap is unknown

Times = NDArray[np.int64]
Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
Fault = tuple[int, str]  # row of the batch at which it is found, text


class SensorHealth:
    """Monitor of consecutive batches; each fault is reported once while it lasts."""

    def __init__(self) -> None:
        self._last_t_ns: int | None = None
        self._unusable = _Run(coded("samples-unusable", "no usable inertial sample for 1 s"))
        self._stuck = _Run(
            coded("sensor-stuck", "the inertial sensor has repeated one value for 1 s")
        )
        self._accel_hangs = _Hang(
            coded("accel-stuck", "the accelerometer has repeated a value while the unit turned"),
            _TURNING_RADPS,
        )
        self._gyro_hangs = _Hang(
            coded("gyro-stuck", "the gyroscope has repeated a value while the unit moved"),
            _SHAKING_MPS2,
        )
        self._last_row: Floats = np.full(6, np.nan)

    def push(self, imu: ImuBatch) -> list[str]:
        """Return new faults in this batch; mostly none."""
        if not len(imu):
            return []
        t_ns = imu.t_ns
        rows = np.hstack((imu.accel_mps2, imu.gyro_radps))
        first_ns = t_ns[0] if self._last_t_ns is None else self._last_t_ns
        steps_ns = np.diff(t_ns, prepend=first_ns)
        repeats = rows == np.vstack((self._last_row, rows[:-1]))
        usable = np.asarray(np.isfinite(rows).all(axis=1))
        accel, gyro = rows[:, :3], rows[:, 3:]
        faults = [
            *_time_faults(steps_ns),
            *self._unusable.push(t_ns, ~usable),
            *self._stuck.push(t_ns, usable & repeats.all(axis=1)),
            *self._accel_hangs.push(steps_ns, accel, gyro, repeats[:, :3]),
            *self._gyro_hangs.push(steps_ns, gyro, accel, repeats[:, 3:]),
        ]
        self._last_t_ns, self._last_row = int(t_ns[-1]), rows[-1]
        return [text for _, text in sorted(faults, key=lambda fault: fault[0])]


def _time_faults(steps_ns: Times) -> Iterator[Fault]:
    for row in np.flatnonzero(np.abs(steps_ns) > _LASTING_NS):
        step_ns = int(steps_ns[row])
        if step_ns > 0:
            text = coded(
                "samples-missing",
                "no inertial sample for {missing_s:.1f} s",
                missing_s=step_ns / NS_PER_S,
            )
        else:
            text = coded(
                "samples-clock-back",
                "the samples' clock went back by {back_s:.1f} s",
                back_s=-step_ns / NS_PER_S,
            )
        yield int(row), text


class _Run:
    """Run of consecutive samples with a property."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._since_ns: int | None = None  # of the run that lasts
        self._reported = False

    def push(self, t_ns: Times, holds: Flags) -> Iterator[Fault]:
        if not holds.any():
            self._since_ns, self._reported = None, False
            return
        begins = _last_rows(~holds) + 1  # by row: the first row of the run it is in, if it is
        since_ns = t_ns[np.minimum(begins, len(t_ns) - 1)]
        if self._since_ns is not None:
            since_ns = np.where(begins == 0, self._since_ns, since_ns)
        lasts = holds & (t_ns - since_ns >= _LASTING_NS)
        reported = 0 if self._reported else -1  # first row of the run that was reported last
        for row in np.flatnonzero(lasts):
            if begins[row] != reported:
                reported = begins[row]
                yield int(row), self._text
        self._since_ns = int(since_ns[-1]) if holds[-1] else None
        self._reported = bool(holds[-1]) and reported == begins[-1]


class _Hang:
    """Axis of one of the two sensors that repeats itself while the other sensor shows motion.

    A coarse sensor at rest repeats its value too, and is no fault; neither is an axis that was
    always zero.
    """

    def __init__(self, text: str, motion: float) -> None:
        """``motion``: change of the other sensor while the unit moves, in its unit."""
        self._text = text
        self._motion = motion
        self._reported = False
        # By axis, of the value that it has shown last:
        self._has_varied = np.zeros(3, bool)
        self._other_before = np.full((3, 3), np.nan)  # of the other sensor, where the value began
        self._lasts_ns = np.zeros(3, np.int64)
        self._moved_ns = np.zeros(3, np.int64)  # of these, how long the other was far from there

    def push(self, steps_ns: Times, own: Floats, other: Floats, repeats: Flags) -> Iterator[Fault]:
        """``own``, ``other``: of the two sensors, n x 3; ``repeats``: where ``own`` has the value
        of the sample before, n x 3.
        """
        if not self._has_varied.all():
            varies = np.abs(own) > 0.0  # and is not NaN
            varied_before = np.logical_or.accumulate(np.vstack((self._has_varied, varies)))
            repeats = repeats & varied_before[:-1]
            self._has_varied = varied_before[-1]
        if not repeats.any():
            self._other_before = np.tile(other[-1], (3, 1))
            self._lasts_ns, self._moved_ns = np.zeros((2, 3), np.int64)
            self._reported = False
            return
        begins = _last_rows(~repeats)
        steps_ns = np.clip(steps_ns, 0, _LONGEST_STEP_NS)
        lasting_ns, moving_ns = np.zeros((2, *own.shape), np.int64)
        rows, axes = np.nonzero(repeats)
        lasting_ns[rows, axes] = steps_ns[rows]
        moves = _is_farther(
            other[rows], self._before(begins[rows, axes], axes, other), self._motion
        )
        moving_ns[rows, axes] = np.where(moves, steps_ns[rows], 0)
        lasts_ns = _sums_since(begins, lasting_ns, self._lasts_ns)
        moved_ns = _sums_since(begins, moving_ns, self._moved_ns)
        self._other_before = self._before(begins[-1], np.arange(3), other)
        self._lasts_ns, self._moved_ns = lasts_ns[-1], moved_ns[-1]
        hangs = np.any((lasts_ns >= _LASTING_NS) & (moved_ns >= _MOVED_NS), axis=1)
        for row in np.flatnonzero(hangs & ~np.append(self._reported, hangs[:-1])):
            yield int(row), self._text
        self._reported = bool(hangs[-1])

    def _before(self, begins: Rows, axes: Rows, other: Floats) -> Floats:
        """Values of the other sensor where those of these axes began."""
        return np.where(begins[:, None] < 0, self._other_before[axes], other[begins])


def _is_farther(here: Floats, there: Floats, distance: float) -> Flags:
    """``here``, ``there``: n x 3."""
    with np.errstate(invalid="ignore", over="ignore"):  # of samples that are not usable
        x, y, z = (here - there).T
        return np.asarray(np.hypot(np.hypot(x, y), z) > distance)


def _last_rows(flags: Flags) -> Rows:
    """By row: the last row up to it that is flagged; -1 before the first.  Each column apart."""
    rows = np.arange(len(flags)).reshape(-1, *(1,) * (flags.ndim - 1))
    return np.maximum.accumulate(np.where(flags, rows, -1))


def _sums_since(begins: Rows, steps_ns: Times, before_ns: Times) -> Times:
    """By row: the sum of the steps behind row ``begins``; ``before_ns`` more where that is before
    the batch.  Each column apart.
    """
    sums_ns = np.cumsum(steps_ns, axis=0)
    at_begin_ns = np.take_along_axis(sums_ns, np.maximum(begins, 0), axis=0)
    return sums_ns - np.where(begins < 0, -before_ns, at_begin_ns)
