"""Rate limit for log lines that other machines can cause: once a minute, with a count."""

from __future__ import annotations

import logging

from shared.clock import NS_PER_S, Clock

APART_NS = 60 * NS_PER_S


class RateLimitFilter(logging.Filter):
    """Filter for the logger of a library that logs every wrong request, with few different
    sentences.
    """

    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self._clock = clock
        # By message: time of logging, and how often it was left out since.
        self._logged: dict[str, tuple[int, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        if record.levelno > logging.WARNING or not isinstance(record.msg, str):
            return True
        now_ns = self._clock.monotonic_ns()
        logged_ns, left_out = self._logged.get(record.msg, (now_ns - APART_NS, 0))
        if now_ns - logged_ns < APART_NS:
            self._logged[record.msg] = logged_ns, left_out + 1
            return False
        self._logged[record.msg] = now_ns, 0
        if left_out:
            record.msg = f"{record.msg} (and {left_out} times more in the minutes before)"
        return True
