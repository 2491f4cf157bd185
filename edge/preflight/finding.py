"""Findings of a check, and what they add up to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

import msgspec

from shared.coded_text import CodedText, Term, coded

NO_READING = coded("check-no-reading", "no reading")
HAS_NONE = coded("check-none", "the unit has none")


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


def subject(code: str, words: str) -> CodedText:
    """Subject of a finding with its code."""
    return coded("check-subject", "{subject}", subject=Term(code, words))


def subject_of(code: str, words: str, sensor: str) -> CodedText:
    """Subject of a finding about one of several sensors; ``sensor`` empty: of the only one."""
    if not sensor:
        return subject(code, words)
    return coded(
        "check-subject-of", "{subject} of {sensor}", subject=Term(code, words), sensor=sensor
    )


def worst(findings: Iterable[CheckFinding]) -> Severity:
    """Return the gravest level; OK where there is no finding."""
    levels = {finding.level for finding in findings}
    return next(
        (level for level in (Severity.FAILED, Severity.WARNING) if level in levels), Severity.OK
    )
