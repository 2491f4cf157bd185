"""The air around the equipment is hot.

Thermal classes and the dose: ``base_station.core.units.thermal_dose``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import ADVISORY, EMERGENCY, WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from base_station.core.units.thermal_dose import CAUTION_DEGC, CRITICAL_DEGC, WARNING_DEGC
from shared.coded_text import coded
from shared.config import Within
from shared.errors import ConfigError
from shared.messages import AlarmParameters, Message, Temperature

_PRIORITIES = {"caution": ADVISORY, "warning": WARNING, "critical": EMERGENCY}


@dataclass(frozen=True, slots=True)
class Heat:
    caution_degc: Annotated[float, Within(30.0, 1000.0)] = CAUTION_DEGC
    warning_degc: Annotated[float, Within(30.0, 1000.0)] = WARNING_DEGC
    critical_degc: Annotated[float, Within(30.0, 1000.0)] = CRITICAL_DEGC
    hysteresis_degc: Annotated[float, Within(0.0, 50.0)] = 10.0
    name: str = "heat"
    levels: tuple[str, ...] = ("caution", "warning", "critical")
    clear_after_s: Annotated[float, Within(0.0, 600.0)] = 10.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = (Temperature,)

    def __post_init__(self) -> None:
        if not self.caution_degc < self.warning_degc < self.critical_degc:
            raise ConfigError("caution_degc, warning_degc and critical_degc must rise")

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        heat = unit.heat
        if heat.temperature is None:
            return None
        ambient_degc = heat.temperature.ambient_degc
        found = self._level(ambient_degc, level)
        if not found:
            return Clear(heat.temperature_ns, coded("over-cooled", "cooled down"))
        return Finding(
            found,
            _PRIORITIES[found],
            "heat",
            AlarmParameters(
                member=unit.name, temperature_degc=ambient_degc, heat_fraction=heat.dose
            ),
            seen_ns=heat.temperature_ns,
            measured=ambient_degc,
        )

    def _level(self, ambient_degc: float, level: str) -> str:
        """Return the worst level whose limit is reached; the present level is left a little below
        its limit.
        """
        limits = (self.caution_degc, self.warning_degc, self.critical_degc)
        standing = self.levels.index(level) if level else -1
        found = ""
        for rank, (name, limit_degc) in enumerate(zip(self.levels, limits, strict=True)):
            if ambient_degc >= limit_degc - (self.hysteresis_degc if rank <= standing else 0.0):
                found = name
        return found
