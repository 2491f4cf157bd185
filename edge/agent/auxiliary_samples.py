"""Samples beside the inertial ones: the messages that they become, and readings for the status."""

from __future__ import annotations

from edge.agent.batteries import Batteries
from edge.agent.decimation import OncePerPeriod
from edge.agent.sighting_limit import SightingLimit
from edge.agent.temperatures import AmbientTemperature, CurrentReadings
from edge.sample_codec.codec import gps_fix, is_sendable, sighting
from edge.samples import (
    AmbientSample,
    BatterySample,
    ElectronicsSample,
    GpsSample,
    OtherSample,
    SightingSample,
)
from shared.channels import GPS, TEMPERATURE
from shared.header_factory import HeaderFactory
from shared.messages import Message, SensorTemperature, Temperature


class AuxiliarySamples:
    """Temperatures, fixes, sightings and batteries of one unit; presses are none of them."""

    def __init__(self, header_factory: HeaderFactory) -> None:
        self._header_factory = header_factory
        self._gps_times = OncePerPeriod(GPS.regular_rate_hz)
        self._ambient = AmbientTemperature(TEMPERATURE.regular_rate_hz)
        self._electronics = CurrentReadings()
        self._batteries = Batteries()
        self._sighting_limit = SightingLimit()
        self.has_gps = False  # True once there was a fix

    def take(self, sample: OtherSample, mono_ns: int) -> list[Message]:
        """Return the messages of a sample; ``mono_ns``: its time by the unit's clock."""
        match sample:
            case AmbientSample():
                return self._take_ambient(sample, mono_ns)
            case ElectronicsSample():
                self._electronics.push(sample.sensor, sample.t_ns, sample.temperature_degc)
            case GpsSample():
                self.has_gps = True
                if self._gps_times.takes(sample.t_ns):
                    return [gps_fix(self._header_factory.header(mono_ns), sample)]
            case SightingSample():
                return self._take_sighting(sample, mono_ns)
            case BatterySample():
                self._batteries.push(sample)
        return []

    def electronics(self, t_ns: int) -> tuple[SensorTemperature, ...]:
        """Return the current temperatures of the electronics."""
        return self._electronics.at(t_ns)

    def emptiest_battery(self, t_ns: int) -> BatterySample | None:
        """Return the reading of the battery that is the emptiest; None: there is none."""
        return self._batteries.emptiest(t_ns)

    def _take_ambient(self, sample: AmbientSample, mono_ns: int) -> list[Message]:
        found = self._ambient.push(sample)
        return [] if found is None else [Temperature(self._header_factory.header(mono_ns), *found)]

    def _take_sighting(self, sample: SightingSample, mono_ns: int) -> list[Message]:
        if not (is_sendable(sample) and self._sighting_limit.takes(sample)):
            return []
        return [sighting(self._header_factory.header(mono_ns), sample)]
