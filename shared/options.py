"""Checks of options that their parsers do not make."""

from __future__ import annotations

import math

import typer


def finite(value: float | None) -> float | None:
    """Callback of an option: a range lets NaN pass, as NaN is neither below nor above a limit.

    Raises ``typer.BadParameter``, which names the option and ends the command with exit code 2.
    """
    if value is not None and not math.isfinite(value):
        raise typer.BadParameter(f"{value} is no number that can be used here.")
    return value


def number_within(text: str, least: float, most: float) -> float | None:
    """Number that a text gives; None where it gives none, or one beyond the limits."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if least <= number <= most else None
