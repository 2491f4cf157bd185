"""Alarm: the unit moves as no foot does, so its tracker cannot estimate the wearer's position."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message
from shared.quality import Reason


@dataclass(frozen=True, slots=True)
class WornWrong:
    """Raised and cleared by the unit's own mounting check, which has its own hysteresis."""

    name: str = "worn-wrong"
    levels: tuple[str, ...] = ("not-on-foot",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        off, position = switched_off(unit), unit.position
        if off is not None:
            return off
        if position is None or unit.position_ns < unit.began_ns:
            return None
        if not position.reasons & Reason.NOT_ON_FOOT:
            return Clear(
                unit.position_ns, coded("over-worn-right", "the unit moves with a foot again")
            )
        return Finding(
            "not-on-foot",
            WARNING,
            "not-on-foot",
            AlarmParameters(member=unit.name),
            seen_ns=unit.position_ns,
        )
