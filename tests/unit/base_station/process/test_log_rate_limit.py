"""Invalid requests to a server do not fill the disk with log lines."""

from __future__ import annotations

import logging

import pytest

from base_station.process.log_rate_limit import RateLimitFilter
from shared.clock import ManualClock

log = logging.getLogger("tested.seldom")


def test_same_line_is_logged_once_a_minute_with_its_count(
    caplog: pytest.LogCaptureFixture,
) -> None:
    clock = ManualClock()
    seldom = RateLimitFilter(clock)
    log.addFilter(seldom)
    try:
        for _ in range(1000):
            log.warning("invalid")
        log.warning("another")
        clock.advance(61.0)
        log.warning("invalid")
        log.warning("invalid")
        clock.advance(61.0)
        log.warning("another")
    finally:
        log.removeFilter(seldom)
    assert [one.getMessage() for one in caplog.records] == [
        "invalid",
        "another",
        "invalid (and 999 times more in the minutes before)",
        "another",
    ]


def test_error_of_the_program_is_logged_each_time(caplog: pytest.LogCaptureFixture) -> None:
    seldom = RateLimitFilter(ManualClock())
    log.addFilter(seldom)
    try:
        for _ in range(3):
            log.error("failed")
    finally:
        log.removeFilter(seldom)
    assert len(caplog.records) == 3
