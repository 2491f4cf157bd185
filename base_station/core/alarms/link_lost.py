"""No message of a unit for too long.  It gives no information about the wearer."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.alarms.interface import ADVISORY, WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from base_station.core.state.message_stream import LOST_AFTER_S, STALE_AFTER_S
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message


@dataclass(frozen=True, slots=True)
class LinkLost:
    lost_after_s: float = LOST_AFTER_S
    live_within_s: float = STALE_AFTER_S
    name: str = "link-lost"
    levels: tuple[str, ...] = ("switched off", "lost")
    clear_after_s: float = 3.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.last_message_ns is None:
            return None
        silent_s = (t_ns - unit.last_message_ns) / NS_PER_S
        if silent_s < self.live_within_s:
            return Clear(unit.last_message_ns, coded("over-messages-return", "messages return"))
        if silent_s < self.lost_after_s:
            return None
        stopped = unit.stopped_ns is not None
        return Finding(
            "switched off" if stopped else "lost",
            ADVISORY if stopped else WARNING,
            "unit-off" if stopped else "signal-lost",
            AlarmParameters(member=unit.name, duration_s=silent_s),
            seen_ns=unit.last_message_ns,
            onset_ns=unit.last_message_ns,
            measured=silent_s,
        )
