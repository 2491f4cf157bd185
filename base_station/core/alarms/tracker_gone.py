"""Alarm: a unit sends raw samples, and the agent that tracks for it is silent.  The console then
shows the wearer at the last position, although the wearer moves.
"""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import WARNING, Clear, Finding, Verdict, switched_off
from base_station.core.state import UnitState
from base_station.core.state.message_stream import LOST_AFTER_S, STALE_AFTER_S
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class TrackerGone:
    gone_after_s: float = LOST_AFTER_S
    live_within_s: float = STALE_AFTER_S
    name: str = "tracker-gone"
    levels: tuple[str, ...] = ("gone",)
    clear_after_s: float = 3.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.last_message_ns is None:
            return None
        if not unit.is_tracked_remotely:
            return Clear(
                unit.last_message_ns, coded("over-tracks-itself", "the unit tracks itself")
            )
        off = switched_off(unit)
        if off is not None:
            return off
        last_message_ns = None if unit.tracker is None else unit.tracker.last_message_ns
        if last_message_ns is not None and (t_ns - last_message_ns) / NS_PER_S < self.live_within_s:
            return Clear(
                last_message_ns, coded("over-agent-speaks", "its tracking agent speaks again")
            )
        since_ns = max(
            last_message_ns or 0, unit.boots[-1].first_live_ns
        )  # it may start with the unit
        if (t_ns - since_ns) / NS_PER_S < self.gone_after_s:
            return None
        return Finding(
            "gone",
            WARNING,
            "agent-never-started" if last_message_ns is None else "agent-silent",
            AlarmParameters(member=unit.name, unit_id=unit.unit_id),
            seen_ns=since_ns,
            onset_ns=since_ns,
        )
