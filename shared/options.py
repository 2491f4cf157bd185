"""Options that several commands have, and checks that parsers do not make."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import Annotated

import typer


def utc_time(text: str) -> datetime:
    """Parser of an option; UTC where the text names no other zone.  Raises typer.BadParameter."""
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        raise typer.BadParameter(f"{text} is no time like 2026-03-01T10:00:00Z") from None
    return time if time.tzinfo else time.replace(tzinfo=UTC)


Start = Annotated[
    datetime | None,
    typer.Option("--start", parser=utc_time, metavar="TIME", help="UTC, 2026-03-01T10:00:00Z."),
]
End = Annotated[
    datetime | None,
    typer.Option("--end", parser=utc_time, metavar="TIME", help="Until before it."),
]


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
