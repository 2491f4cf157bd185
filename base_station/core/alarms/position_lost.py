"""For a while nobody has known where a wearer is to better than a house."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.config import Within
from shared.messages import Message


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
            return Clear(seen_ns, "the position is known again")
        if seen_ns - place.lost_since_ns < self.after_s * NS_PER_S:
            return None
        return Finding(
            "lost",
            WARNING,
            f"The position of {unit.name} is lost ({fused.quality_reason})",
            seen_ns=seen_ns,
            onset_ns=place.lost_since_ns,
        )
