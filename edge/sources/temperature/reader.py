"""Reader of a unit's temperature sensors, each in a thread of its own."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from edge.samples import AmbientSample, ElectronicsSample
from edge.sources.polled_device import PolledDevice, Unreadable
from edge.sources.temperature.interface import RANGE_DEGC, SensorRole, TemperatureSensor
from shared.clock import Clock
from shared.coded_text import coded

_PERIOD_S = 0.5


@dataclass(frozen=True, slots=True)
class NamedSensor:
    """Sensor as it was set."""

    name: str
    text: str  # as in the settings, for a person
    role: SensorRole
    sensor: TemperatureSensor

    def read(self, clock: Clock) -> AmbientSample | ElectronicsSample | Unreadable:
        found = self.sensor.read_degc()
        if isinstance(found, Unreadable):
            return found
        least_degc, most_degc = RANGE_DEGC
        if not least_degc <= found <= most_degc:
            return Unreadable(
                coded(
                    "temperature-impossible",
                    "it shows {shown}, which is not between {least_degc:g} and {most_degc:g} °C: "
                    "the sensor is open, shorted or set wrongly",
                    shown=f"{found:.0f} °C" if math.isfinite(found) else "?",
                    least_degc=least_degc,
                    most_degc=most_degc,
                )
            )
        kind = AmbientSample if self.role is SensorRole.ENVIRONMENT else ElectronicsSample
        return kind(clock.monotonic_ns(), found, self.name)


class TemperatureReader:
    """``start``, then ``take`` what was read; see ``edge.sources.interface.AuxiliarySource``."""

    def __init__(self, sensors: Iterable[NamedSensor], clock: Clock) -> None:
        self._devices = [_device(sensor, clock) for sensor in sensors]

    def start(self) -> None:
        for device in self._devices:
            device.start()

    def take(self) -> tuple[AmbientSample | ElectronicsSample, ...]:
        return tuple(sample for device in self._devices for sample in device.take())

    def take_faults(self) -> tuple[str, ...]:
        return tuple(fault for device in self._devices for fault in device.take_faults())

    def close(self) -> None:
        for device in self._devices:
            device.stop()
        for device in self._devices:
            device.join()


def _device(sensor: NamedSensor, clock: Clock) -> PolledDevice[AmbientSample | ElectronicsSample]:
    title = coded(
        "device-temperature",
        "temperature sensor {name} ({settings})",
        name=sensor.name,
        settings=sensor.text,
    )
    return PolledDevice(title, lambda: sensor.read(clock), _PERIOD_S, clock)
