"""The agent that tracks for a unit reports a fault of its own, such as of its disk.

The unit itself is well: nothing is to be repaired there.
"""

from __future__ import annotations

from dataclasses import dataclass

from msgspec.structs import replace

from base_station.core.alarms.interface import WARNING, Finding, Verdict
from base_station.core.person_references import without_numbers
from base_station.core.state import UnitState
from shared.messages import Message


@dataclass(frozen=True, slots=True)
class TrackerFault:
    name: str = "tracker-fault"
    levels: tuple[str, ...] = ("fault",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        agent = unit.tracker
        if agent is None or agent.fault is None or not unit.is_tracked_remotely:
            return None
        fault = agent.fault
        return Finding(
            "fault",
            WARNING,
            "agent-fault",
            replace(fault.parameters, member=unit.name, unit_id=agent.unit_id),
            seen_ns=fault.t_ns,
            onset_ns=fault.t_ns,
            latched=True,
            about=without_numbers(fault.text),
        )
