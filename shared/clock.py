"""Clocks as a port, so that everything above the rim can be tested without waiting."""

from __future__ import annotations

import time
from typing import Protocol

NS_PER_S = 1_000_000_000
NS_PER_MS = 1_000_000
NS_PER_DAY = 86_400 * NS_PER_S


class Clock(Protocol):
    def monotonic_ns(self) -> int:
        """Never goes back; its zero means nothing."""
        ...

    def utc_ns(self) -> int:
        """Nanoseconds since 1970-01-01 UTC, as far as this machine knows."""
        ...


class SystemClock:
    """The machine's own clocks."""

    def monotonic_ns(self) -> int:
        return time.monotonic_ns()

    def utc_ns(self) -> int:
        return time.time_ns()


class ManualClock:
    """A clock that a test sets; UTC runs beside monotonic time."""

    def __init__(self, utc_ns: int = 1_700_000_000 * NS_PER_S) -> None:
        self._monotonic_ns = 0
        self._utc_offset_ns = utc_ns

    def monotonic_ns(self) -> int:
        return self._monotonic_ns

    def utc_ns(self) -> int:
        return self._utc_offset_ns + self._monotonic_ns

    def advance(self, duration_s: float) -> None:
        self._monotonic_ns += round(duration_s * NS_PER_S)
