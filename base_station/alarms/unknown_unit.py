"""A unit that nobody registered is heard: it is kept and shown, and not believed."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.alarms.port import INFORMATION, Clear, Finding, Verdict
from base_station.live_state import UnitState
from shared.messages import Message


@dataclass(frozen=True, slots=True)
class UnknownUnit:
    name: str = "unknown-unit"
    levels: tuple[str, ...] = ("unknown",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    for_strangers: bool = True
    heeds: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.heard_ns is None:
            return None
        if unit.registered:
            return Clear(unit.heard_ns, "registered")
        return Finding(
            "unknown",
            INFORMATION,
            f"A unit that is not registered is sending: {unit.unit_id}",
            seen_ns=unit.heard_ns,
        )
