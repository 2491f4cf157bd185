"""Alarm: for some time the position of a wearer has been uncertain by the size of a house."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, FusedPosition, Message
from shared.quality import NOT_OF_STEPS, Quality, codes_of


@dataclass(frozen=True, slots=True)
class PositionLost:
    after_s: Annotated[float, Within(5.0, 600.0)] = 15.0
    name: str = "position-lost"
    levels: tuple[str, ...] = ("lost",)
    clear_after_s: Annotated[float, Within(0.0, 600.0)] = 10.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        off, place = switched_off(unit), unit.place
        fused = place.fused
        if off is not None:
            return off
        if fused is None or fused.t_meas_ns < unit.began_ns:
            return None
        seen_ns = fused.header.t_utc_ns
        if place.lost_since_ns is None:
            return Clear(seen_ns, coded("over-position-known", "the position is known again"))
        if seen_ns - place.lost_since_ns < self.after_s * NS_PER_S:
            return None
        code, parameters = _code_and_parameters(unit, fused)
        return Finding(
            "lost",
            WARNING,
            code,
            parameters,
            seen_ns=seen_ns,
            onset_ns=place.lost_since_ns,
        )


def _code_and_parameters(unit: UnitState, fused: FusedPosition) -> tuple[str, AlarmParameters]:
    """Return code and parameters: the unit's tracker is lost, or the uncertainty too large."""
    position = unit.position
    if position is not None and position.path_quality is Quality.LOST:
        reasons = codes_of(position.reasons & ~NOT_OF_STEPS)
        return "position-lost-tracker", AlarmParameters(member=unit.name, reasons=reasons)
    radius_m = 2.0 * math.hypot(fused.std_north_m, fused.std_east_m)
    return "position-lost", AlarmParameters(member=unit.name, radius_m=radius_m)
