"""Parts of a report, checked: unusable ones are left out, each with a warning.

A dispatch with a wrong time is still a fire: only a report without a number is refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from typing import Any

from shared.clock import NS_PER_MS, NS_PER_S
from shared.errors import WireError

NUMBER_CHARACTERS, TEXT_CHARACTERS, REMARKS_CHARACTERS = 128, 200, 1000
CALL_SIGN_CHARACTERS, MOST_UNITS, MOST_WARNINGS = 32, 100, 20
_NOWHERE_DEG = 1e-6
_AHEAD_NS = 86_400 * NS_PER_S  # of the station's clock
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_FIRST = datetime(2000, 1, 1, tzinfo=UTC)
_LAST = datetime(2200, 1, 1, tzinfo=UTC)


class ReportParts:
    """Gives the parts of one report, and collects the warnings."""

    def __init__(self, now_ns: int) -> None:
        """``now_ns``: station time (UTC)."""
        self._now_ns = now_ns
        self._warnings: dict[str, None] = {}

    @property
    def warnings(self) -> tuple[str, ...]:
        found = tuple(self._warnings)
        rest = len(found) - MOST_WARNINGS
        return found if rest <= 0 else (*found[:MOST_WARNINGS], f"{rest} more warnings")

    def warn(self, warning: str) -> None:
        self._warnings[warning] = None

    def number(self, value: Any, name: str) -> str:
        """Number of the dispatch.  Raises WireError where there is none."""
        text = plain(str(value)) if _is_text(value) else ""
        if not 0 < len(text) <= NUMBER_CHARACTERS:
            raise WireError(
                f"the report has no number: give {name}, 1 to {NUMBER_CHARACTERS} characters; "
                "nothing was taken"
            )
        return text

    def text(self, value: Any, name: str, longest: int = TEXT_CHARACTERS) -> str:
        if value is None:
            return ""
        if not _is_text(value):
            self.warn(f"{name} is no text and is left out")
            return ""
        text = plain(str(value))
        if len(text) > longest:
            self.warn(f"{name} is longer than {longest} characters and is cut off")
        return text[:longest]

    def call_signs(self, values: Iterable[Any], name: str) -> tuple[str, ...]:
        """Each once, in their order."""
        found: dict[str, None] = {}
        for value in values:
            text = self.text(value, name, CALL_SIGN_CHARACTERS)
            if text:
                found[text] = None
        if len(found) > MOST_UNITS:
            self.warn(f"{len(found) - MOST_UNITS} units beyond the first {MOST_UNITS} are left out")
        return tuple(found)[:MOST_UNITS]

    def time_ns(self, value: Any, name: str) -> int:
        """UTC in nanoseconds since 1970, to the millisecond; 0: unknown."""
        if value is None or value == "":
            return 0
        try:
            at = datetime.fromisoformat(value)
        except (TypeError, ValueError):
            self.warn(f"{name} is no time as 2026-03-01T14:02:11+01:00 and is left out")
            return 0
        if at.tzinfo is None:
            self.warn(f"{name} has no time zone and is left out")
            return 0
        if not _FIRST <= at < _LAST:
            self.warn(f"{name} ({value}) makes no sense and is left out")
            return 0
        t_ns = (at - _EPOCH) // timedelta(milliseconds=1) * NS_PER_MS
        if t_ns > self._now_ns + _AHEAD_NS:
            self.warn(f"{name} ({value}) is more than a day ahead and is left out")
            return 0
        return t_ns

    def position_deg(
        self, lat: Any, lon: Any, name: str
    ) -> tuple[float, float] | tuple[None, None]:
        """Latitude and longitude (WGS-84)."""
        if not _is_number(lat) or not _is_number(lon):
            self.warn(f"{name} is no latitude and longitude and is left out")
            return None, None
        if abs(lat) > 90.0 or abs(lon) > 180.0:
            self.warn(f"{name} ({lat}, {lon}) is no place on the Earth and is left out")
            return None, None
        if abs(lat) < _NOWHERE_DEG and abs(lon) < _NOWHERE_DEG:
            self.warn(f"{name} is 0, 0, which stands for no place, and is left out")
            return None, None
        return float(lat), float(lon)


def plain(text: str) -> str:
    """Text in one line, without characters that cannot be seen."""
    return " ".join("".join(one if one.isprintable() else " " for one in text).split())


def _is_text(value: Any) -> bool:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return isinstance(value, str) or is_number


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
