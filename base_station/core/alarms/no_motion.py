"""No motion, like a PASS device, which it supplements and never replaces.

Pre-alert at 20 s, alarm at 30 s (published devices: 18-20 s and 25-30 s).  Motion cancels the
pre-alert only; the full alarm stays until a person resets it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import EMERGENCY, WARNING, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.errors import ConfigError
from shared.messages import AlarmParameters, Message, Status


@dataclass(frozen=True, slots=True)
class NoMotion:
    pre_alert_s: Annotated[float, Within(5.0, 300.0)] = 20.0
    alarm_s: Annotated[float, Within(5.0, 300.0)] = 30.0
    name: str = "no-motion"
    levels: tuple[str, ...] = ("pre-alert", "alarm")
    clear_after_s: float = 0.0
    rearm_after_s: Annotated[float, Within(5.0, 600.0)] = 30.0
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = (Status,)

    def __post_init__(self) -> None:
        if self.pre_alert_s > self.alarm_s:
            raise ConfigError("pre_alert_s comes before alarm_s, not after it")

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        if unit.status is None:
            return None
        motionless_s = unit.status.motionless_s
        seen_ns = unit.status_ns
        if motionless_s < self.pre_alert_s:
            return Clear(seen_ns, coded("over-motion", "motion"))
        full = motionless_s >= self.alarm_s
        onset_ns = seen_ns - round(motionless_s * NS_PER_S)
        lying_from_ns = onset_ns + round(self.pre_alert_s * NS_PER_S)
        now, then = unit.name, unit.name_at(lying_from_ns)
        return Finding(
            "alarm" if full else "pre-alert",
            EMERGENCY if full else WARNING,
            "no-motion",
            AlarmParameters(
                member=now,
                member_before=None if now == then else then,
                duration_s=motionless_s,
            ),
            seen_ns=seen_ns,
            onset_ns=onset_ns,
            latched=full,
            about=unit.wearer.from_ns(lying_from_ns),
            measured=motionless_s,
        )
