"""Current temperatures of a unit's sensors."""

from __future__ import annotations

import math

from edge.agent.decimation import Decimator
from edge.samples import AmbientSample
from shared.clock import NS_PER_S
from shared.messages import SensorTemperature

_CURRENT_NS = 5 * NS_PER_S  # an older reading is not used
_STEP_DEGC = 5.0  # change that is published at once

Ambient = tuple[float, tuple[SensorTemperature, ...]]


class CurrentReadings:
    """Newest reading of each sensor, by name."""

    def __init__(self) -> None:
        self._readings: dict[str, tuple[int, float]] = {}

    def push(self, sensor: str, t_ns: int, degc: float) -> None:
        if math.isfinite(degc):
            self._readings[sensor] = t_ns, degc

    def at(self, t_ns: int) -> tuple[SensorTemperature, ...]:
        """Return the current readings; old ones are left out."""
        return tuple(
            SensorTemperature(sensor, degc)
            for sensor, (read_ns, degc) in sorted(self._readings.items())
            if abs(t_ns - read_ns) <= _CURRENT_NS
        )


class AmbientTemperature:
    """Highest reading of the air sensors: once a period, and at once after a step."""

    def __init__(self, rate_hz: float) -> None:
        self._times = Decimator(rate_hz)
        self._readings = CurrentReadings()
        self._published_degc = math.nan

    def push(self, sample: AmbientSample) -> Ambient | None:
        """Return the sample to publish: the highest reading, and those of named sensors."""
        if not math.isfinite(sample.temperature_degc):
            return None
        self._readings.push(sample.sensor, sample.t_ns, sample.temperature_degc)
        current = self._readings.at(sample.t_ns)
        hottest_degc = max(reading.temperature_degc for reading in current)
        is_due = self._times.takes(sample.t_ns)
        if not is_due and not abs(hottest_degc - self._published_degc) >= _STEP_DEGC:
            return None
        self._published_degc = hottest_degc
        return hottest_degc, tuple(reading for reading in current if reading.name)
