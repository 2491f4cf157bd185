"""Actions on alarms and their thresholds."""

from __future__ import annotations

import msgspec


class AcknowledgeAlarm(msgspec.Struct, frozen=True):
    alarm_id: str
    last_raised_ms: int = 0  # of the raising that the user saw; 0: unknown


class ResolveAlarm(msgspec.Struct, frozen=True):
    alarm_id: str
    note: str
    last_raised_ms: int = 0  # as above
    reason: str = ""  # code of ``ResolutionReason``; empty: none was given


class SetThresholds(msgspec.Struct, frozen=True):
    """Thresholds of alarm rules, by ``rule.threshold``; what is not named has its default."""

    thresholds: dict[str, float]
