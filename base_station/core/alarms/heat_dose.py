"""The equipment has been hot for so long in this incident that it may fail, however cool it is now.

Thermal classes and the dose: ``base_station.core.units.thermal_dose``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, Message, Temperature


@dataclass(frozen=True, slots=True)
class HeatDose:
    used_up: Annotated[float, Within(0.1, 10.0)] = 1.0
    name: str = "heat-dose"
    levels: tuple[str, ...] = ("used up",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = (Temperature,)

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        heat = unit.heat
        if heat.temperature is None:
            return None
        if heat.dose < self.used_up:
            return Clear(heat.temperature_ns, coded("over-other-incident", "another incident"))
        is_late = heat.dose - heat.late_dose < self.used_up
        return Finding(
            "used up",
            WARNING,
            "heat-limit-late" if is_late else "heat-limit",
            AlarmParameters(member=unit.name),
            seen_ns=heat.temperature_ns,
            measured=heat.dose,
        )
