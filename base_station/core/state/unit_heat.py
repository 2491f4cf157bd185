"""Heat at a unit: its last reading, and the thermal dose of the incident."""

from __future__ import annotations

import msgspec

from base_station.core.state.exposure import ExposureInterval
from shared.messages import Temperature


class UnitHeat(msgspec.Struct):
    """The dose is of the equipment, in this incident; 1: its heat budget is used up."""

    temperature: Temperature | None = None
    temperature_ns: int = 0  # station time of receipt
    dose: float = 0.0
    late_dose: float = 0.0  # of that, what came out of the journal
    exposures: list[ExposureInterval] = msgspec.field(default_factory=list)
