"""A member's PAR has not been confirmed in time.

Only a confirmation ends it: by the button of the own unit, or by radio.  It is raised once; the
next confirmation arms it again, and so does the next PAR request that is not answered.
"""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.accountability import ANSWER_NS
from base_station.core.alarms.interface import EMERGENCY, Clear, Finding, Verdict, off_duty
from base_station.core.state import UnitState
from base_station.core.state.duty import Duty
from shared.clock import NS_PER_S
from shared.coded_text import code_of_text, coded, with_code
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class MissedCheckIn:
    name: str = "missed-check-in"
    levels: tuple[str, ...] = ("overdue",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        duty = unit.duty
        if duty is None:
            return off_duty(unit)
        if t_ns < duty.due_ns:
            about = unit.wearer.from_ns(t_ns)
            return Clear(duty.counts_from_ns, _resolution_text(duty), about=about)
        answers_due_ns = [open_request_ns + ANSWER_NS for open_request_ns in duty.open_requests_ns]
        onset_ns = max(due_ns for due_ns in (duty.due_ns, *answers_due_ns) if due_ns <= t_ns)
        return Finding(
            "overdue",
            EMERGENCY,
            _text_code(duty),
            AlarmParameters(
                member=unit.name, duration_s=(onset_ns - duty.counts_from_ns) / NS_PER_S
            ),
            seen_ns=duty.counts_from_ns,
            onset_ns=onset_ns,
            about=unit.wearer.from_ns(t_ns),
            measured=(t_ns - duty.due_ns) / NS_PER_S,
        )


def _text_code(duty: Duty) -> str:
    is_asked = duty.open_request_ns is not None
    if duty.confirmation is None:
        return "par-overdue-no-answer-yet" if is_asked else "par-overdue-unconfirmed"
    return "par-overdue-unanswered" if is_asked else "par-overdue"


def _resolution_text(duty: Duty) -> str:
    """With the author of the last confirmation, who is a name and no part of the code."""
    if duty.confirmation is None:
        code = coded("over-not-overdue", "not overdue; PAR not yet confirmed")
    elif duty.confirmation.source == "self":
        code = coded("over-confirmed-self", "not overdue; PAR confirmed by own unit")
    else:
        code = coded("over-confirmed-radio", "not overdue; PAR confirmed by radio")
    return with_code(f"not overdue; {duty.confirmation_text}", code_of_text(code))
