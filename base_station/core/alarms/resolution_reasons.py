"""Reasons for which a user resolves an alarm; the log has the code, consoles have the text."""

from __future__ import annotations

from enum import StrEnum


class ResolutionReason(StrEnum):
    FALSE_ALARM = "false_alarm"
    MEMBER_WELL = "member_well"  # spoken to, or seen
    FOUND_AND_HELPED = "found_and_helped"
    CAUSE_REMOVED = "cause_removed"  # cooled, charged, linked again ...
    UNIT_FAULT = "unit_fault"
    TRAINING = "training"
    OTHER = "other"  # read from the note
