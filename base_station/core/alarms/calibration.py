"""Alarm: a unit's sensors were calibrated long ago, or badly, so its tracker is less accurate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from base_station.core.alarms.interface import ADVISORY, Clear, Finding, Verdict
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.config import Within
from shared.messages import AlarmParameters, Message

_DAY_S = 86_400


@dataclass(frozen=True, slots=True)
class CalibrationPoor:
    """A unit without a calibration raises no alarm: not every sensor needs one."""

    old_after_days: Annotated[float, Within(1.0, 3650.0)] = 180.0
    name: str = "calibration"
    levels: tuple[str, ...] = ("old", "poor")
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:  # noqa: ARG002
        description = unit.description
        if description is None or unit.last_message_ns is None:
            return None
        made_s = description.calibrated_s
        if made_s is None:
            return Clear(
                unit.last_message_ns, coded("over-no-calibration", "the unit uses no calibration")
            )
        if description.calibration_faults:
            parameters = AlarmParameters(member=unit.name, fault=description.calibration_faults)
            return _finding("poor", parameters, unit.last_message_ns)
        if unit.last_message_ns / NS_PER_S - made_s > self.old_after_days * _DAY_S:
            parameters = AlarmParameters(member=unit.name, calibrated_s=made_s)
            return _finding("old", parameters, unit.last_message_ns)
        return Clear(
            unit.last_message_ns, coded("over-calibration-good", "the unit uses a good calibration")
        )


def _finding(level: str, parameters: AlarmParameters, seen_ns: int) -> Finding:
    return Finding(level, ADVISORY, f"calibration-{level}", parameters, seen_ns=seen_ns)
