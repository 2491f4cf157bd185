"""Accelerometer and gyroscope that are two devices, joined onto the timeline of the gyroscope.

An error of rotation turns every acceleration that follows, so rotation stays as it was measured,
and acceleration is interpolated to its times.  Where there is no acceleration on both sides, near
enough, there is no sample.
"""

from __future__ import annotations

import numpy as np

from edge.samples import Floats, Nanoseconds
from edge.sources.iio.block import Block
from edge.sources.iio.conversion import ACCEL, GYRO
from shared.clock import NS_PER_S

_NEAR_PERIODS = 3.0  # of the accelerometer: beyond, what it did between is not known
_PATIENCE_NS = NS_PER_S  # for acceleration that belongs to a rotation


class JoinedTimeline:
    """``push`` what either gives; ``take`` what is complete."""

    def __init__(self, accel_rate_hz: float) -> None:
        self._near_ns = _NEAR_PERIODS * NS_PER_S / accel_rate_hz
        self._accel = _Series()
        self._gyro = _Series()
        self._left_out = 0  # rotations without acceleration

    def push(self, block: Block) -> None:
        for kind, series in ((ACCEL, self._accel), (GYRO, self._gyro)):
            if kind in block.values:
                series.push(block)

    def take(self) -> Block:
        """Return samples with both, in time order."""
        accel, gyro = self._accel, self._gyro
        if not len(accel.t_ns) or not len(gyro.t_ns):
            self._give_up()
            return Block()
        count = int(np.searchsorted(gyro.t_ns, accel.t_ns[-1], side="right"))
        times_ns, rotation, degc = gyro.cut(count)
        after = np.searchsorted(accel.t_ns, times_ns, side="left")
        is_exact = accel.t_ns[after] == times_ns if count else np.empty(0, bool)
        before = np.where(is_exact, after, np.maximum(after - 1, 0))
        has_both = is_exact | (
            (after > 0) & (accel.t_ns[after] - accel.t_ns[before] <= self._near_ns)
        )
        span_ns = np.maximum(accel.t_ns[after] - accel.t_ns[before], 1)
        share = ((times_ns - accel.t_ns[before]) / span_ns)[:, None]
        force = accel.values[before] + share * (accel.values[after] - accel.values[before])
        if accel.degc is not None:
            degc = accel.degc[after]
        self._left_out += int((~has_both).sum())
        if count:
            accel.cut(int(before[-1]))
        self._give_up()
        return Block(times_ns, {ACCEL: force, GYRO: rotation}, degc).part(has_both)

    def take_left_out(self) -> int:
        """Return how many rotations have been left out since the last call."""
        left_out, self._left_out = self._left_out, 0
        return left_out

    def _give_up(self) -> None:
        """Leave out what has waited long for the other device, which may be gone."""
        rotations, forces = self._gyro, self._accel
        if len(rotations.t_ns):
            waited = rotations.t_ns < rotations.t_ns[-1] - _PATIENCE_NS
            self._left_out += int(waited.sum())
            rotations.cut(int(waited.sum()))
        if len(forces.t_ns):
            forces.cut(int((forces.t_ns < forces.t_ns[-1] - _PATIENCE_NS).sum()))


class _Series:
    """Samples of one device that wait for those of the other one."""

    def __init__(self) -> None:
        self.t_ns: Nanoseconds = np.empty(0, np.int64)
        self.values: Floats = np.empty((0, 3))
        self.degc: Floats | None = None

    def push(self, block: Block) -> None:
        (values,) = block.values.values()
        self.t_ns = np.concatenate((self.t_ns, block.t_ns))
        self.values = np.concatenate((self.values, values))
        if block.temperature_degc is not None:
            before = np.empty(0) if self.degc is None else self.degc
            self.degc = np.concatenate((before, block.temperature_degc))

    def cut(self, count: int) -> tuple[Nanoseconds, Floats, Floats | None]:
        """Return the first samples, which wait no longer."""
        cut = self.t_ns[:count], self.values[:count]
        self.t_ns, self.values = self.t_ns[count:], self.values[count:]
        degc = None
        if self.degc is not None:
            degc, self.degc = self.degc[:count], self.degc[count:]
        return *cut, degc
