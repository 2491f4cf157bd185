"""Magnetometer and barometer beside an inertial sensor, each read in a thread of its own.

A value that has not changed is no new measurement: the sensor had none yet, or it is stuck.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from edge.sources.device_name import DeviceName, find_device
from edge.sources.iio.attributes import (
    IIO_DEVICES,
    UnusableDeviceError,
    read_number,
    read_scaled,
)
from edge.sources.iio.conversion import MAG, PRESSURE, UT_PER_GAUSS, axes_of, read_conversion
from edge.sources.polled_device import PolledDevice, Unreadable
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded, text_of_error

MAG_PERIOD_S, _PRESSURE_PERIOD_S = 0.05, 0.1
_PA_PER_KPA = 1000.0
_PRESSURE_PA = (20_000.0, 130_000.0)  # beyond, it is no air pressure
STUCK_NS = 10 * NS_PER_S

Values = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Reading:
    t_ns: int  # this machine's monotonic clock
    values: Values


class SlowSensor:
    """``start``, then ``take`` new readings."""

    def __init__(
        self, title: str, read: Callable[[], Values | Unreadable], period_s: float, clock: Clock
    ) -> None:
        self._read = read
        self._clock = clock
        self._last: Reading | None = None  # the first one with the values that it shows now
        self._device = PolledDevice(title, self._read_timed, period_s, clock)

    def start(self) -> None:
        self._device.start()

    def take(self) -> list[Reading]:
        taken: list[Reading] = []
        for reading in self._device.take():
            if self._last is None or reading.values != self._last.values:
                self._last = reading
                taken.append(reading)
        return taken

    def take_faults(self) -> tuple[str, ...]:
        return self._device.take_faults()

    def close(self) -> None:
        self._device.stop()
        self._device.join()

    def _read_timed(self) -> Reading | Unreadable:
        t_ns = self._clock.monotonic_ns()
        values = self._read()
        if isinstance(values, Unreadable):
            return values
        last = self._last
        if last is not None and values == last.values and t_ns - last.t_ns > STUCK_NS:
            return Unreadable(
                coded(
                    "reading-stuck",
                    "it has repeated one value for {stuck_s:.0f} s: it hangs",
                    stuck_s=STUCK_NS / NS_PER_S,
                )
            )
        return Reading((t_ns + self._clock.monotonic_ns()) // 2, values)


def open_magnetometer(name: DeviceName, sysfs: Path, clock: Clock) -> SlowSensor:
    """Return a sensor of ``(x, y, z)`` in uT, in the axes of the hardware."""

    def read(device: Path) -> Values:
        raw = np.array([[read_number(device / f"{axis}_raw") for axis in axes_of(MAG)]])
        field_ut = UT_PER_GAUSS * read_conversion(device, MAG).apply(raw)[0]
        return tuple(field_ut.tolist())

    title = coded("device-magnetometer", "magnetometer {name}", name=str(name))
    return SlowSensor(title, _reader_of(name, sysfs, read), MAG_PERIOD_S, clock)


def open_barometer(name: DeviceName, sysfs: Path, clock: Clock) -> SlowSensor:
    """Return a sensor of ``(pressure,)`` in Pa."""

    def read(device: Path) -> Values:
        pressure_pa = _PA_PER_KPA * read_scaled(device, PRESSURE, PRESSURE)
        least_pa, most_pa = _PRESSURE_PA
        if not least_pa <= pressure_pa <= most_pa:
            raise UnusableDeviceError(
                coded(
                    "pressure-impossible",
                    "it shows {pressure_pa:.0f} Pa, which is no air pressure",
                    pressure_pa=round(pressure_pa),
                )
            )
        return (pressure_pa,)

    title = coded("device-barometer", "barometer {name}", name=str(name))
    return SlowSensor(title, _reader_of(name, sysfs, read), _PRESSURE_PERIOD_S, clock)


def _reader_of(
    name: DeviceName, sysfs: Path, read: Callable[[Path], Values]
) -> Callable[[], Values | Unreadable]:
    def find_and_read() -> Values | Unreadable:
        device = find_device(sysfs / IIO_DEVICES, name, "IIO device")
        if isinstance(device, Unreadable):
            return device
        try:
            values = read(device)
        except UnusableDeviceError as error:
            return Unreadable(text_of_error(error))
        if all(map(math.isfinite, values)):
            return values
        return Unreadable(coded("reading-no-number", "it shows no number"))

    return find_and_read
