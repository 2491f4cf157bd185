"""Clock of a receiver: its UTC mapped to this machine's monotonic clock.

A fix is of an instant that the receiver knows to the microsecond, and comes some tenths of a second
later, by a line that may hold it for longer.  No fix arrives before its instant: the fix with the
least delay of the last half minute gives the offset of the two clocks, and every other is placed by
its own UTC.  The delay of that one is stated (``latency_s``).

Only the time of day is used, so a receiver without a date, or one that is 1024 weeks off, serves as
well.  UTC that jumps (a leap second learnt late, a receiver started anew) is used when it has
lasted for three seconds: shorter jumps may be a delay of the line.
"""

from __future__ import annotations

import logging
from collections import deque

from shared.clock import NS_PER_S

logger = logging.getLogger(__name__)

_DAY_NS = 86_400 * NS_PER_S
_WINDOW_NS = 30 * NS_PER_S
_JUMP_NS = NS_PER_S // 2  # from the quickest: more is a line that waits, or another clock
_DELAY_MAX_NS = 10 * NS_PER_S  # no line holds a fix for longer
_STEADY_NS = NS_PER_S // 4  # a clock that jumped stays there
_CONFIRMED_NS = 3 * NS_PER_S
_CONFIRMED = 3  # fixes


class FixClock:
    """Mapping; ``place`` fixes as they come."""

    def __init__(self, latency_s: float) -> None:
        self._latency_ns = round(latency_s * NS_PER_S)
        self._origin_ns = 0  # of lateness, so that midnight is no jump
        self._late: deque[tuple[int, int]] = deque()  # arrival and lateness, of the last seconds
        self._unconfirmed: list[tuple[int, int]] = []  # the same, of what may be another clock
        self._last_of_day_ns: int | None = None
        self.repeated = 0  # fixes of the instant of the one before
        self.implausible = 0  # fixes whose time cannot be

    def place(self, of_day_ns: int | None, arrival_ns: int) -> int | None:
        """Return when a fix was valid; None of a repeated one, or where its time is implausible.

        ``of_day_ns``: UTC since midnight; None: by when it came.
        """
        if of_day_ns is None:
            return arrival_ns - self._latency_ns
        if of_day_ns == self._last_of_day_ns:
            self.repeated += 1
            return None
        self._last_of_day_ns = of_day_ns
        late_ns = self._lateness_ns(of_day_ns, arrival_ns)
        least_ns = min((late for _, late in self._late), default=late_ns)
        if abs(late_ns - least_ns) <= _JUMP_NS:
            self._unconfirmed.clear()
            self._late.append((arrival_ns, late_ns))
            waited_ns = max(0, late_ns - least_ns)
        elif self._is_another_clock(late_ns, arrival_ns):
            logger.info("a receiver's clock moved by %.1f s", (least_ns - late_ns) / NS_PER_S)
            self._late = deque(self._unconfirmed)
            self._unconfirmed = []
            waited_ns = late_ns - min(late for _, late in self._late)
        elif late_ns - least_ns > _DELAY_MAX_NS:
            self.implausible += 1
            return None
        else:  # held by the line; or early, and then as it came until more is known
            waited_ns = max(0, late_ns - least_ns)
        return arrival_ns - waited_ns - self._latency_ns

    def _lateness_ns(self, of_day_ns: int, arrival_ns: int) -> int:
        """Return the delay of a fix beyond that of the first of the window, or of the one before
        it.
        """
        while self._late and arrival_ns - self._late[0][0] > _WINDOW_NS:
            self._late.popleft()
        if not self._late:
            self._origin_ns = arrival_ns - of_day_ns
        half_ns = _DAY_NS // 2
        return (arrival_ns - of_day_ns - self._origin_ns + half_ns) % _DAY_NS - half_ns

    def _is_another_clock(self, late_ns: int, arrival_ns: int) -> bool:
        if self._unconfirmed and abs(late_ns - self._unconfirmed[0][1]) > _STEADY_NS:
            self._unconfirmed.clear()
        self._unconfirmed.append((arrival_ns, late_ns))
        since_ns = arrival_ns - self._unconfirmed[0][0]
        return len(self._unconfirmed) > _CONFIRMED and since_ns >= _CONFIRMED_NS
