"""Collector of the samples of the next batch.

What comes more rarely stands in the row that follows it; elsewhere it is NaN.
"""

from __future__ import annotations

import numpy as np

from edge.samples import ElectronicsSample, Floats, ImuBatch, SensorBatch
from edge.sources.iio.block import Block
from edge.sources.iio.conversion import ACCEL, GYRO
from edge.sources.iio.slow_sensors import Reading
from shared.clock import NS_PER_S

_TEMPERATURE_NS = NS_PER_S  # between two in the unit's status
_WAITING_MAX = 1000  # readings that wait for a row; the oldest are left out


class Rows:
    """Collector; ``mag`` and ``pressure``: whether there is such a sensor."""

    def __init__(self, sensor: str, *, mag: bool, pressure: bool) -> None:
        self._sensor = sensor  # name of its temperature
        self._blocks: list[Block] = []
        self._mag: list[Reading] | None = [] if mag else None
        self._pressure: list[Reading] | None = [] if pressure else None
        self._temperature_due_ns = 0
        self._last_ns = 0  # time of the newest row

    def __len__(self) -> int:
        return sum(len(block) for block in self._blocks)

    @property
    def span_ns(self) -> int:
        return int(self._blocks[-1].t_ns[-1] - self._blocks[0].t_ns[0]) if self._blocks else 0

    def add(self, block: Block) -> int:
        """Return how many were taken: times go forward, whatever a device that was opened anew
        says.
        """
        is_new = block.t_ns > self._last_ns
        count = int(is_new.sum())
        if count:
            self._blocks.append(block if count == len(block) else block.part(is_new))
            self._last_ns = int(block.t_ns[-1])
        return count

    def add_mag(self, readings: list[Reading]) -> None:
        if self._mag is not None:
            self._mag = [*self._mag, *readings][-_WAITING_MAX:]

    def add_pressure(self, readings: list[Reading]) -> None:
        if self._pressure is not None:
            self._pressure = [*self._pressure, *readings][-_WAITING_MAX:]

    def cut(self) -> SensorBatch:
        """Return everything so far; there is something."""
        t_ns = np.concatenate([block.t_ns for block in self._blocks])
        degc = self._temperature()
        mag_ut, self._mag = _placed(self._mag, t_ns, 3)
        pressure_pa, self._pressure = _placed(self._pressure, t_ns, 1)
        imu = ImuBatch(
            t_ns=t_ns,
            accel_mps2=np.concatenate([block.values[ACCEL] for block in self._blocks]),
            gyro_radps=np.concatenate([block.values[GYRO] for block in self._blocks]),
            mag_ut=mag_ut,
            pressure_pa=None if pressure_pa is None else pressure_pa[:, 0],
            imu_temperature_degc=degc,
        )
        self._blocks = []
        return SensorBatch(imu, self._electronics(imu))

    def _temperature(self) -> Floats | None:
        if all(block.temperature_degc is None for block in self._blocks):
            return None
        columns = []
        for block in self._blocks:
            degc = block.temperature_degc
            columns.append(np.full(len(block), np.nan) if degc is None else degc)
        return np.concatenate(columns)

    def _electronics(self, imu: ImuBatch) -> tuple[ElectronicsSample, ...]:
        if imu.imu_temperature_degc is None or imu.t_ns[-1] < self._temperature_due_ns:
            return ()
        known = np.flatnonzero(np.isfinite(imu.imu_temperature_degc))
        if not len(known):
            return ()
        t_ns, degc = int(imu.t_ns[known[-1]]), float(imu.imu_temperature_degc[known[-1]])
        self._temperature_due_ns = t_ns + _TEMPERATURE_NS
        return (ElectronicsSample(t_ns, degc, self._sensor),)


def _placed(
    readings: list[Reading] | None, t_ns: np.ndarray, width: int
) -> tuple[Floats | None, list[Reading] | None]:
    """Return a column with the readings before its last row, and those that wait."""
    if readings is None:
        return None, None
    column = np.full((len(t_ns), width), np.nan)
    waiting = [reading for reading in readings if reading.t_ns > t_ns[-1]]
    for reading in readings[: len(readings) - len(waiting)]:
        column[np.searchsorted(t_ns, reading.t_ns)] = reading.values
    return column, waiting
