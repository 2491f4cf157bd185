"""Alarm: the unit detected a fall; an operator must find out how the wearer is."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import EMERGENCY, Finding, Verdict
from base_station.core.state import UnitState
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class Fall:
    name: str = "fall"
    levels: tuple[str, ...] = ("fall",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        fall = unit.fall
        if fall.t_ns is None:
            return None
        now, before = unit.names_at(fall.dated_ns)
        return Finding(
            "fall",
            EMERGENCY,
            "fall",
            AlarmParameters(member=now, member_before=before),
            seen_ns=fall.t_ns,
            onset_ns=fall.t_ns,
            latched=True,
            about=unit.wearer.from_ns(fall.dated_ns),
        )
