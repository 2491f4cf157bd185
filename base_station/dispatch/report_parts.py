"""Parts of a report, checked: invalid ones are left out, each with a warning.

A dispatch with a wrong time is still a fire, so only a report without a number is refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from typing import Any

from shared.clock import NS_PER_MS, NS_PER_S
from shared.coded_text import CodedText, TextCode, code_of_text, coded
from shared.errors import WireError

NUMBER_CHARACTERS, TEXT_CHARACTERS, REMARKS_CHARACTERS = 128, 200, 1000
CALL_SIGN_CHARACTERS, MOST_UNITS, MOST_WARNINGS = 32, 100, 20
_NOWHERE_DEG = 1e-6
_AHEAD_NS = 86_400 * NS_PER_S  # of the station's clock
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_FIRST = datetime(2000, 1, 1, tzinfo=UTC)
_LAST = datetime(2200, 1, 1, tzinfo=UTC)


class ReportParts:
    """Reader of the parts of one report, which collects the warnings."""

    def __init__(self, now_ns: int) -> None:
        """``now_ns``: station time (UTC)."""
        self._now_ns = now_ns
        self._warnings: dict[CodedText, None] = {}

    @property
    def warnings(self) -> tuple[str, ...]:
        return tuple(map(str, self._first_warnings()))

    @property
    def warning_codes(self) -> tuple[TextCode, ...]:
        """Codes of ``warnings``, in their order."""
        return tuple(map(code_of_text, self._first_warnings()))

    def _first_warnings(self) -> tuple[str, ...]:
        found = tuple(self._warnings)
        rest = len(found) - MOST_WARNINGS
        if rest <= 0:
            return found
        return (*found[:MOST_WARNINGS], coded("more-warnings", "{count} more warnings", count=rest))

    def warn(self, warning: CodedText) -> None:
        self._warnings[warning] = None

    def number(self, value: Any, name: str) -> str:
        """Number of the dispatch.  Raises WireError if there is none."""
        text = plain(str(value)) if _is_text(value) else ""
        if not 0 < len(text) <= NUMBER_CHARACTERS:
            raise WireError(
                coded(
                    "report-no-number",
                    "The report has no number: give {part}, 1 to {longest} characters; nothing "
                    "was taken.",
                    part=name,
                    longest=NUMBER_CHARACTERS,
                )
            )
        return text

    def text(self, value: Any, name: str, longest: int = TEXT_CHARACTERS) -> str:
        if value is None:
            return ""
        if not _is_text(value):
            self.warn(coded("report-no-text", "{part} is no text and is left out", part=name))
            return ""
        text = plain(str(value))
        if len(text) > longest:
            self.warn(
                coded(
                    "report-text-too-long",
                    "{part} is longer than {longest} characters and is cut off",
                    part=name,
                    longest=longest,
                )
            )
        return text[:longest]

    def call_signs(self, values: Iterable[Any], name: str) -> tuple[str, ...]:
        """Call signs in their order, each once."""
        found: dict[str, None] = {}
        for value in values:
            text = self.text(value, name, CALL_SIGN_CHARACTERS)
            if text:
                found[text] = None
        if len(found) > MOST_UNITS:
            self.warn(
                coded(
                    "report-too-many-units",
                    "{count} units beyond the first {most} are left out",
                    count=len(found) - MOST_UNITS,
                    most=MOST_UNITS,
                )
            )
        return tuple(found)[:MOST_UNITS]

    def time_ns(self, value: Any, name: str) -> int:
        """UTC in nanoseconds since 1970, to the millisecond; 0 if unknown."""
        if value is None or value == "":
            return 0
        try:
            at = datetime.fromisoformat(value)
        except (TypeError, ValueError):
            self.warn(
                coded(
                    "report-no-time",
                    "{part} is no time as 2026-03-01T14:02:11+01:00 and is left out",
                    part=name,
                )
            )
            return 0
        if at.tzinfo is None:
            self.warn(coded("report-no-zone", "{part} has no time zone and is left out", part=name))
            return 0
        if not _FIRST <= at < _LAST:
            self.warn(
                coded(
                    "report-time-odd",
                    "{part} ({value}) makes no sense and is left out",
                    part=name,
                    value=value,
                )
            )
            return 0
        t_ns = (at - _EPOCH) // timedelta(milliseconds=1) * NS_PER_MS
        if t_ns > self._now_ns + _AHEAD_NS:
            self.warn(
                coded(
                    "report-time-ahead",
                    "{part} ({value}) is more than a day ahead and is left out",
                    part=name,
                    value=value,
                )
            )
            return 0
        return t_ns

    def position_deg(
        self, lat: Any, lon: Any, name: str
    ) -> tuple[float, float] | tuple[None, None]:
        """Latitude and longitude (WGS-84)."""
        if not _is_number(lat) or not _is_number(lon):
            self.warn(
                coded(
                    "report-no-position",
                    "{part} is no latitude and longitude and is left out",
                    part=name,
                )
            )
            return None, None
        if abs(lat) > 90.0 or abs(lon) > 180.0:
            self.warn(
                coded(
                    "report-not-on-earth",
                    "{part} ({lat_deg}, {lon_deg}) is no place on the Earth and is left out",
                    part=name,
                    lat_deg=lat,
                    lon_deg=lon,
                )
            )
            return None, None
        if abs(lat) < _NOWHERE_DEG and abs(lon) < _NOWHERE_DEG:
            self.warn(
                coded(
                    "report-position-zero",
                    "{part} is 0, 0, which stands for no place, and is left out",
                    part=name,
                )
            )
            return None, None
        return float(lat), float(lon)


def plain(text: str) -> str:
    """Text in one line, without invisible characters."""
    return " ".join("".join(one if one.isprintable() else " " for one in text).split())


def _is_text(value: Any) -> bool:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return isinstance(value, str) or is_number


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
