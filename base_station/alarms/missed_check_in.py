"""Nobody has heard from a person for longer than the incident's roll call (PAR) allows.

Only a person's word ends it: the wearer's button or somebody at the console.  Raised once; the
next check-in arms it again, and so does a call that is not answered in its turn.
"""

from __future__ import annotations

from dataclasses import dataclass

from base_station.accountability import ANSWER_NS
from base_station.alarms.port import IMMEDIATE, Clear, Finding, Verdict
from base_station.live_state import UnitState
from shared.clock import NS_PER_S
from shared.messages import Message


@dataclass(frozen=True, slots=True)
class MissedCheckIn:
    name: str = "missed-check-in"
    levels: tuple[str, ...] = ("overdue",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    for_strangers: bool = False
    heeds: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        duty = unit.duty
        if duty is None:
            return Clear(unit.off_duty_ns, "off duty")
        if t_ns < duty.due_ns:
            heard_by = f"not overdue; last heard by {duty.checked_in_by}"
            return Clear(duty.checked_in_ns, heard_by, about=unit.worn_from_ns(t_ns))
        answers_due_ns = [asked_ns + ANSWER_NS for asked_ns in duty.asks_ns]
        onset_ns = max(due_ns for due_ns in (duty.due_ns, *answers_due_ns) if due_ns <= t_ns)
        silent_min = (onset_ns - duty.checked_in_ns) / NS_PER_S / 60.0
        asked = "asked and " if duty.asked_ns is not None else ""
        return Finding(
            "overdue",
            IMMEDIATE,
            f"{unit.name}: PAR overdue, {asked}not heard from for {silent_min:.0f} min",
            seen_ns=duty.checked_in_ns,
            onset_ns=onset_ns,
            about=unit.worn_from_ns(t_ns),
        )
