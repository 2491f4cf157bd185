"""The wearer pressed the mayday button: at once, until a person at the station resolves it."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import EMERGENCY, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message, Status


@dataclass(frozen=True, slots=True)
class Mayday:
    name: str = "mayday"
    levels: tuple[str, ...] = ("mayday",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = (Status,)

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        call = unit.mayday
        if call.t_ns is None:
            return None
        if call.cancelled_ns is not None:
            return Clear(call.cancelled_ns, coded("over-cancelled", "cancelled by the wearer"))
        now, before = unit.names_at(call.dated_ns)
        return Finding(
            "mayday",
            EMERGENCY,
            "mayday",
            AlarmParameters(member=now, member_before=before),
            seen_ns=call.t_ns,
            onset_ns=call.t_ns,
            latched=True,
            about=unit.wearer.from_ns(call.dated_ns),
        )
