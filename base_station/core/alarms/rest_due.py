"""A person has worked for long and should be sent to rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import ADVISORY, Clear, Finding, Verdict, off_duty
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class RestDue:
    name: str = "rest-due"
    levels: tuple[str, ...] = ("due",)
    clear_after_s: float = 0.0
    rearm_after_s: Annotated[float, Within(30.0, 43_200.0)] = 600.0
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        duty = unit.duty
        if duty is None:
            return off_duty(unit)
        about = unit.wearer.from_ns(t_ns)
        if duty.rest_since_ns is not None:
            return Clear(duty.rest_since_ns, coded("over-rests", "rests"), about=about)
        if duty.work_since_ns is None or duty.rest_due_ns is None or t_ns < duty.rest_due_ns:
            return Clear(duty.ready_ns, coded("over-not-due", "not due"), about=about)
        worked_s = (t_ns - duty.work_since_ns) / NS_PER_S
        return Finding(
            "due",
            ADVISORY,
            "work-limit",
            AlarmParameters(member=unit.name, duration_s=worked_s),
            seen_ns=duty.work_since_ns,
            onset_ns=duty.rest_due_ns,
            about=about,
            measured=(t_ns - duty.work_since_ns) / NS_PER_S,
        )
