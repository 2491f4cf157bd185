"""Fixes of a unit's receiver are impossible, so that its position does not use them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from base_station.fusion.gnss.fix_faults import fault_code
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class GpsUnused:
    after_s: Annotated[float, Within(5.0, 600.0)] = 30.0
    name: str = "gps-unused"
    levels: tuple[str, ...] = ("unused",)
    clear_after_s: float = 3.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        off, gps = switched_off(unit), unit.gps
        if off is not None:
            return off
        if gps is None or gps.t_ns < unit.began_ns:
            return None
        if gps.faulty_since_ns is None:
            return Clear(
                gps.t_ns,
                coded("over-gps-plausible", "the positions of the receiver are plausible again"),
            )
        if gps.t_ns - gps.faulty_since_ns < self.after_s * NS_PER_S:
            return None
        return Finding(
            "unused",
            WARNING,
            "gps-unused",
            AlarmParameters(member=unit.name, reasons=(fault_code(gps.reason),)),
            seen_ns=gps.t_ns,
            onset_ns=gps.faulty_since_ns,
        )
