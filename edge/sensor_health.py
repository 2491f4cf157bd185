"""Faults of the inertial sensor that last: a person must hear of them.

Single bad samples are the tracker's business, which leaves them out and says so in the
position's reasons.
"""

from __future__ import annotations

import numpy as np

from edge.samples import ImuBatch
from shared.clock import NS_PER_S

_LASTING_NS = NS_PER_S


class SensorHealth:
    """Watches consecutive batches; each fault is told once while it lasts."""

    def __init__(self) -> None:
        self._last_t_ns: int | None = None
        self._unusable = _Run("no usable inertial sample for 1 s")
        self._stuck = _Run("the inertial sensor has repeated one value for 1 s")
        self._last_row: tuple[float, ...] | None = None

    def push(self, imu: ImuBatch) -> list[str]:
        """What a person must hear of this batch; mostly nothing."""
        faults: list[str] = []
        rows = np.hstack((imu.accel_mps2, imu.gyro_radps))
        finite = np.asarray(np.isfinite(rows).all(axis=1)).tolist()
        for t_ns, row, usable in zip(imu.t_ns.tolist(), rows.tolist(), finite, strict=True):
            faults += self._time_fault(t_ns)
            faults += self._unusable.step(t_ns, holds=not usable)
            values = tuple(row)
            faults += self._stuck.step(t_ns, holds=usable and values == self._last_row)
            self._last_row = values
            self._last_t_ns = t_ns
        return faults

    def _time_fault(self, t_ns: int) -> list[str]:
        if self._last_t_ns is None:
            return []
        step_ns = t_ns - self._last_t_ns
        if step_ns > _LASTING_NS:
            return [f"no inertial sample for {step_ns / NS_PER_S:.1f} s"]
        if step_ns < -_LASTING_NS:
            return [f"the samples' clock went back by {-step_ns / NS_PER_S:.1f} s"]
        return []


class _Run:
    """Consecutive samples of which something holds."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._since_ns: int | None = None
        self._told = False

    def step(self, t_ns: int, *, holds: bool) -> list[str]:
        if not holds:
            self._since_ns, self._told = None, False
            return []
        if self._since_ns is None:
            self._since_ns = t_ns
        if self._told or t_ns - self._since_ns < _LASTING_NS:
            return []
        self._told = True
        return [self._text]
