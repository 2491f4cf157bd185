"""The unit's own tracker has not trusted its position for a while."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, Message
from shared.quality import NOT_OF_STEPS, Quality, Reason, codes_of


@dataclass(frozen=True, slots=True)
class TrackerDegraded:
    after_s: Annotated[float, Within(5.0, 600.0)] = 15.0
    name: str = "tracker-degraded"
    levels: tuple[str, ...] = ("degraded", "lost")
    clear_after_s: Annotated[float, Within(0.0, 600.0)] = 10.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        off, position = switched_off(unit), unit.position
        if off is not None:
            return off
        if position is None or unit.position_ns < unit.began_ns:
            return None
        if position.reasons & Reason.NOT_ON_FOOT:
            return None  # the rule ``worn-wrong`` names the cause
        if unit.degraded_since_ns is None:
            return Clear(unit.position_ns, coded("over-tracker-sure", "the tracker is sure again"))
        if unit.position_ns - unit.degraded_since_ns < self.after_s * NS_PER_S:
            return None
        lost = position.path_quality is Quality.LOST
        return Finding(
            "lost" if lost else "degraded",
            WARNING,
            "tracker-lost" if lost else "tracker-unsure",
            AlarmParameters(member=unit.name, reasons=codes_of(position.reasons & ~NOT_OF_STEPS)),
            seen_ns=unit.position_ns,
            onset_ns=unit.degraded_since_ns,
        )
