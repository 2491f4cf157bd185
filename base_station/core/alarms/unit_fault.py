"""A unit reports a fault of a sensor or of its storage."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec.structs import replace

from base_station.core.alarms.interface import WARNING, Finding, Verdict
from base_station.core.person_references import without_numbers
from base_station.core.state import UnitState
from shared.messages import Message


@dataclass(frozen=True, slots=True)
class UnitFault:
    name: str = "unit-fault"
    levels: tuple[str, ...] = ("fault",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.fault is None:
            return None
        return Finding(
            "fault",
            WARNING,
            "unit-fault",
            replace(unit.fault.parameters, member=unit.name),
            seen_ns=unit.fault.t_ns,
            onset_ns=unit.fault.t_ns,
            latched=True,
            about=without_numbers(unit.fault.text),
        )
