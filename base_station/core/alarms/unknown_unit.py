"""A unit that is not registered sends: it is kept and shown, but not used."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import ADVISORY, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class UnknownUnit:
    name: str = "unknown-unit"
    levels: tuple[str, ...] = ("unknown",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = True
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.last_message_ns is None:
            return None
        if unit.registered:
            return Clear(unit.last_message_ns, coded("over-registered", "registered"))
        return Finding(
            "unknown",
            ADVISORY,
            "unregistered-unit",
            AlarmParameters(unit_id=unit.unit_id),
            seen_ns=unit.last_message_ns,
        )
