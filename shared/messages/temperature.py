"""The air around the equipment; it says nothing of the wearer's own condition."""

from __future__ import annotations

import msgspec

from shared.messages.header import Header
from shared.messages.muster.v1 import temperature_pb2
from shared.messages.quantise import signed32


class SensorTemperature(msgspec.Struct, frozen=True):
    """Reading of one named sensor of a unit."""

    name: str
    temperature_degc: float

    def to_wire(self) -> temperature_pb2.SensorTemperature:
        return temperature_pb2.SensorTemperature(
            name=self.name, temperature_cdegc=signed32(self.temperature_degc, 1e2)
        )

    @staticmethod
    def from_wire(wire: temperature_pb2.SensorTemperature) -> SensorTemperature:
        return SensorTemperature(wire.name, wire.temperature_cdegc * 1e-2)


class Temperature(msgspec.Struct, frozen=True, gc=False):
    header: Header
    ambient_degc: float  # of several sensors, the hottest
    sensors: tuple[SensorTemperature, ...] = ()  # by name; empty: one sensor without a name

    def to_wire(self) -> temperature_pb2.Temperature:
        return temperature_pb2.Temperature(
            header=self.header.to_wire(),
            ambient_cdegc=signed32(self.ambient_degc, 1e2),
            sensors=[sensor.to_wire() for sensor in self.sensors],
        )

    @staticmethod
    def from_wire(wire: temperature_pb2.Temperature) -> Temperature:
        return Temperature(
            header=Header.from_wire(wire.header),
            ambient_degc=wire.ambient_cdegc * 1e-2,
            sensors=tuple(map(SensorTemperature.from_wire, wire.sensors)),
        )
