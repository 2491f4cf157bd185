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
        self._axes = [_Axis(), _Axis(), _Axis()]
        self._reported = False

    def push(self, steps_ns: Times, own: Floats, other: Floats, repeats: Flags) -> Iterator[Fault]:
        """``own``, ``other``: of the two sensors, n x 3; ``repeats``: where ``own`` has the value
        of the sample before, n x 3.
        """
        if repeats.any():
            steps_ns = np.clip(steps_ns, 0, _LONGEST_STEP_NS)
        hangs = np.zeros(len(own), bool)
        for number, axis in enumerate(self._axes):
            hangs |= axis.push(steps_ns, own[:, number], other, repeats[:, number], self._motion)
        for row in np.flatnonzero(hangs & ~np.append(self._reported, hangs[:-1])):
            yield int(row), self._text
        self._reported = bool(hangs[-1])


class _Axis:
    """Axis of a sensor, and how long it has shown its last value."""

    def __init__(self) -> None:
        self._has_varied = False
        self._other_before: Floats = np.full(3, np.nan)  # where the value began
        self._lasts_ns = 0
        self._moved_ns = 0  # of these, how long the other sensor was far from where it began

    def push(
        self, steps_ns: Times, own: Floats, other: Floats, repeats: Flags, motion: float
    ) -> Flags:
        """Return the samples at which it hangs."""
        if not self._has_varied:
            varies = np.abs(own) > 0.0  # and is not NaN
            repeats = repeats & np.append(False, np.logical_or.accumulate(varies)[:-1])
            self._has_varied = bool(varies.any())
        if not repeats.any():
            self._other_before, self._lasts_ns, self._moved_ns = other[-1], 0, 0
            return repeats
        begins = _last_rows(~repeats)
        before = np.where(begins[:, None] < 0, self._other_before, other[begins])
        with np.errstate(invalid="ignore", over="ignore"):  # of samples that are not usable
            change = other - before
            moves = np.hypot(np.hypot(change[:, 0], change[:, 1]), change[:, 2]) > motion
        lasts_ns = _sums_since(begins, steps_ns, self._lasts_ns)
        moved_ns = _sums_since(begins, np.where(moves, steps_ns, 0), self._moved_ns)
        self._other_before = before[-1]
        self._lasts_ns, self._moved_ns = int(lasts_ns[-1]), int(moved_ns[-1])
        return (lasts_ns >= _LASTING_NS) & (moved_ns >= _MOVED_NS)


def _last_rows(flags: Flags) -> NDArray[np.int64]:
    """By row: the last row up to it that is flagged; -1 before the first."""
    return np.maximum.accumulate(np.where(flags, np.arange(len(flags)), -1))


def _sums_since(begins: NDArray[np.int64], steps_ns: Times, before_ns: int) -> Times:
    """By row: the sum of the steps behind row ``begins``; ``before_ns`` more where that is before
    the batch.
    """
    sums_ns = np.cumsum(steps_ns)
    return sums_ns - np.where(begins < 0, -before_ns, sums_ns[begins])
