"""Monitor of lasting faults of an inertial sensor, sample by sample: the reference for
``edge.agent.sensor_health``, which examines whole batches.
"""

from __future__ import annotations

import math

import numpy as np

from edge.samples import ImuBatch
from shared.clock import NS_PER_S
from shared.coded_text import coded

_LASTING_NS = NS_PER_S
_TURNING_RADPS = 0.5  # change of the gyroscope in a swing, at least
_SHAKING_MPS2 = 2.0  # change of the accelerometer in a swing, at least
_MOVED_NS = NS_PER_S // 5  # a swing or two
_LONGEST_STEP_NS = NS_PER_S // 10  # motion in a longer gap is unknown


class SteppedSensorHealth:
    """Monitor of consecutive batches; each fault is reported once while it lasts."""

    def __init__(self) -> None:
        self._last_t_ns: int | None = None
        self._unusable = _SteppedRun(coded("samples-unusable", "no usable inertial sample for 1 s"))
        self._stuck = _SteppedRun(
            coded("sensor-stuck", "the inertial sensor has repeated one value for 1 s")
        )
        self._accel_hangs = _SteppedHang(
            coded("accel-stuck", "the accelerometer has repeated a value while the unit turned"),
            _TURNING_RADPS,
        )
        self._gyro_hangs = _SteppedHang(
            coded("gyro-stuck", "the gyroscope has repeated a value while the unit moved"),
            _SHAKING_MPS2,
        )
        self._last_row: tuple[float, ...] | None = None

    def push(self, imu: ImuBatch) -> list[str]:
        """Return new faults in this batch; mostly none."""
        faults: list[str] = []
        rows = np.hstack((imu.accel_mps2, imu.gyro_radps))
        finite = np.asarray(np.isfinite(rows).all(axis=1)).tolist()
        for t_ns, row, usable in zip(imu.t_ns.tolist(), rows.tolist(), finite, strict=True):
            faults += self._time_fault(t_ns)
            faults += self._unusable.step(t_ns, holds=not usable)
            values = tuple(row)
            faults += self._stuck.step(t_ns, holds=usable and values == self._last_row)
            accel, gyro = values[:3], values[3:]
            faults += self._accel_hangs.step(t_ns, accel, gyro)
            faults += self._gyro_hangs.step(t_ns, gyro, accel)
            self._last_row = values
            self._last_t_ns = t_ns
        return faults

    def _time_fault(self, t_ns: int) -> list[str]:
        if self._last_t_ns is None:
            return []
        step_ns = t_ns - self._last_t_ns
        if step_ns > _LASTING_NS:
            return [
                coded(
                    "samples-missing",
                    "no inertial sample for {missing_s:.1f} s",
                    missing_s=step_ns / NS_PER_S,
                )
            ]
        if step_ns < -_LASTING_NS:
            return [
                coded(
                    "samples-clock-back",
                    "the samples' clock went back by {back_s:.1f} s",
                    back_s=-step_ns / NS_PER_S,
                )
            ]
        return []


class _SteppedRun:
    """Run of consecutive samples with a property."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._since_ns: int | None = None
        self._reported = False

    def step(self, t_ns: int, *, holds: bool) -> list[str]:
        if not holds:
            self._since_ns, self._reported = None, False
            return []
        if self._since_ns is None:
            self._since_ns = t_ns
        if self._reported or t_ns - self._since_ns < _LASTING_NS:
            return []
        self._reported = True
        return [self._text]


class _SteppedHang:
    """Axis of one of the two sensors that repeats itself while the other sensor shows motion.

    A coarse sensor at rest repeats its value too, and is no fault; neither is an axis that was
    always zero.
    """

    def __init__(self, text: str, motion: float) -> None:
        """``motion``: change of the other sensor while the unit moves, in its unit."""
        self._text = text
        self._motion = motion
        self._axes = [_SteppedAxis(), _SteppedAxis(), _SteppedAxis()]
        self._last_t_ns = 0
        self._reported = False

    def step(self, t_ns: int, own: tuple[float, ...], other: tuple[float, ...]) -> list[str]:
        step_ns = min(max(t_ns - self._last_t_ns, 0), _LONGEST_STEP_NS)
        self._last_t_ns = t_ns
        for axis, value in zip(self._axes, own, strict=True):
            if value != axis.value or not axis.has_varied:
                axis.begin(value, other)
                continue
            axis.lasts_ns += step_ns
            if math.dist(other, axis.other_before) > self._motion:
                axis.moved_ns += step_ns
        hangs = any(axis.hangs for axis in self._axes)
        faults = [self._text] if hangs and not self._reported else []
        self._reported = hangs
        return faults


class _SteppedAxis:
    """Axis that has shown the same value since ``began``."""

    value = math.nan
    other_before: tuple[float, ...] = ()
    has_varied = False
    lasts_ns = 0
    moved_ns = 0  # of these, how long the other sensor was far from where it began

    def begin(self, value: float, other: tuple[float, ...]) -> None:
        self.value, self.other_before = value, other
        self.has_varied = self.has_varied or abs(value) > 0.0  # and not NaN
        self.lasts_ns = self.moved_ns = 0

    @property
    def hangs(self) -> bool:
        return self.lasts_ns >= _LASTING_NS and self.moved_ns >= _MOVED_NS
