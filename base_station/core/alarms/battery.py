"""The unit's battery is nearly empty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.config import Within
from shared.errors import ConfigError
from shared.messages import AlarmParameters, Message, Status


@dataclass(frozen=True, slots=True)
class BatteryLow:
    low: Annotated[float, Within(0.01, 0.9)] = 0.10
    hysteresis: Annotated[float, Within(0.0, 0.5)] = 0.05
    name: str = "battery"
    levels: tuple[str, ...] = ("low",)
    clear_after_s: Annotated[float, Within(0.0, 600.0)] = 30.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = (Status,)

    def __post_init__(self) -> None:
        if self.low + self.hysteresis > 1.0:
            raise ConfigError("low and hysteresis together are more than a full one has")

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.status is None or unit.status.battery is None:
            return None
        battery = unit.status.battery
        if battery >= self.low + (self.hysteresis if level else 0.0):
            return Clear(unit.status_ns, coded("over-battery", "battery charged or changed"))
        return Finding(
            "low",
            WARNING,
            "battery-low",
            AlarmParameters(member=unit.name, battery_fraction=battery),
            seen_ns=unit.status_ns,
            measured=battery,
            is_low=True,
        )
