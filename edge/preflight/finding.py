"""Findings of a check, and what they add up to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

import msgspec


class Severity(StrEnum):
    """Severity of a finding."""

    OK = "ok"
    WARNING = "warning"  # the unit works, and something of it is missing or weak
    FAILED = "failed"  # the wearer is not tracked, or cannot call


class CheckFinding(msgspec.Struct, frozen=True):
    """Result of one check, for a person."""

    subject: str  # a word or two: link, clock, inertial sensor
    level: Severity
    text: str  # what was found, with numbers
    remedy: str = ""  # what it costs or what to do; empty where all is well


def worst(findings: Iterable[CheckFinding]) -> Severity:
    """Return the gravest level; OK where there is no finding."""
    levels = {finding.level for finding in findings}
    return next(
        (level for level in (Severity.FAILED, Severity.WARNING) if level in levels), Severity.OK
    )
