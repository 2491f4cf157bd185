"""Texts of faults that several parts of a unit report in the same way."""

from __future__ import annotations

from shared.coded_text import CodedText, coded


def fault_of(subject: str, fault: str) -> CodedText:
    """Fault of a device or a sensor, with its name."""
    return coded("fault-of", "{subject}: {fault}", subject=subject, fault=fault)


def no_samples(reason: str) -> CodedText:
    """Reason that an inertial sensor gives nothing."""
    return coded("no-samples", "no samples: {reason}", reason=reason)


def program_error(error: Exception) -> CodedText:
    """An error of a driver or of this program that nothing was prepared for."""
    return coded("program-error", "{kind}: {error}", kind=type(error).__name__, error=str(error))
