"""Durations as text for people."""

from __future__ import annotations

_UNITS = ((86_400.0, "days"), (3_600.0, "hours"), (60.0, "minutes"), (1.0, "seconds"))


def format_duration(span_s: float) -> str:
    """Text in the largest unit of which there are two: ``25 hours``."""
    size_s, unit = next((one for one in _UNITS if span_s >= 2.0 * one[0]), _UNITS[-1])
    count = f"{span_s / size_s:,.0f}"
    return f"{count} {unit.removesuffix('s') if count == '1' else unit}"
