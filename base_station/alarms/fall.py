"""The unit felt a fall; a person at the station has to find out what became of it."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.alarms.port import IMMEDIATE, Finding, Verdict
from base_station.live_state import UnitState
from shared.messages import Message


@dataclass(frozen=True, slots=True)
class Fall:
    name: str = "fall"
    levels: tuple[str, ...] = ("fall",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    for_strangers: bool = False
    heeds: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.fall_ns is None:
            return None
        said_ns = unit.fall_said_ns if unit.fall_is_dated else None
        return Finding(
            "fall",
            IMMEDIATE,
            f"{unit.name_at(said_ns)} may have fallen",
            seen_ns=unit.fall_ns,
            onset_ns=unit.fall_ns,
            latched=True,
            about=unit.worn_from_ns(said_ns),
        )
