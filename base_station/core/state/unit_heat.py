"""Heat at a unit: its last reading, and the thermal dose of the incident."""

from __future__ import annotations

import msgspec

from shared.messages import Temperature


class ExposureInterval(msgspec.Struct):
    """Part of one run of the unit's program in which the temperature is known, without a silence;
    the unit's monotonic time.
    """

    boot_id: int
    first_ns: int
    first_degc: float
    last_ns: int
    last_degc: float


class UnitHeat(msgspec.Struct):
    """The dose is of the equipment, in this incident; 1: its heat budget is used up."""

    temperature: Temperature | None = None
    temperature_ns: int = 0  # station time of receipt
    dose: float = 0.0
    late_dose: float = 0.0  # of that, the part from the journal
    exposures: list[ExposureInterval] = msgspec.field(default_factory=list)
