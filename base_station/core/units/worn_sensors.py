"""Inertial sensors of a unit, and where its wearer has them."""

from __future__ import annotations

import msgspec

from shared.messages import UnitDescription


class DescribedSensor(msgspec.Struct, frozen=True):
    """Description of a sensor, as tables and consoles have it."""

    name: str  # in the unit; empty: its only one
    place: str  # part of the body, such as left_foot; empty: unknown
    place_recognised: bool  # by its motion; else the place is that of the settings
    mount: str  # way of fastening, in words
    model: str


def worn_sensors(description: UnitDescription) -> tuple[DescribedSensor, ...]:
    """Sensors of a unit; of a unit of an earlier version the only one, whose place is unknown."""
    if not description.sensors:
        return (DescribedSensor("", "", False, "", description.sensor_name),)
    return tuple(
        DescribedSensor(one.name, one.place, one.place_recognised, one.mount, one.model)
        for one in description.sensors
    )
