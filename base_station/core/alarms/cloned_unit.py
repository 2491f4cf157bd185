"""Duplicate device: a copied enrolment, or a spare that was given a name in use.

The wearer of one of them is not seen: only one path is shown.
"""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class ClonedUnit:
    gone_after_s: float = 30.0  # without a message of one of the two
    name: str = "cloned-unit"
    levels: tuple[str, ...] = ("cloned",)
    clear_after_s: float = 3.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = True
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        speakers = (unit, unit.tracker) if unit.tracker is not None else (unit,)
        for sender in speakers:
            other = sender.duplicate_device
            if other is None or sender.last_message_ns is None:
                continue
            seen_ns = min(other.last_live_ns, sender.boots[-1].last_live_ns)
            if (sender.last_message_ns - seen_ns) / NS_PER_S < self.gone_after_s:
                return Finding(
                    "cloned",
                    WARNING,
                    "duplicate-unit" if sender is unit else "duplicate-agent",
                    AlarmParameters(member=unit.name, unit_id=unit.unit_id),
                    seen_ns=seen_ns,
                    onset_ns=max(other.first_live_ns, sender.boots[-1].first_live_ns),
                )
        return (
            None
            if unit.last_message_ns is None
            else Clear(unit.last_message_ns, coded("over-one-speaks", "only one speaks"))
        )
