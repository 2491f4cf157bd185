"""Threads that end by an error of the program are reported on the console."""

from __future__ import annotations

import threading
from threading import Thread

import pytest

from base_station.process.thread_crash_monitor import ThreadCrashMonitor


def fail() -> None:
    raise ValueError("nobody thought of this")


def run(name: str) -> None:
    thread = Thread(target=fail, name=name)
    thread.start()
    thread.join()


def test_each_thread_is_named_once_and_its_error_is_logged(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with ThreadCrashMonitor() as ended:
        assert ended.problems() == ()
        for name in ("backfill", "recordings", "backfill"):
            run(name)
        one, other = ended.problems()
    assert "(backfill)" in one
    assert "(recordings)" in other
    assert "nobody thought of this" in caplog.text


def test_later_threads_end_as_before() -> None:
    before = threading.excepthook
    with ThreadCrashMonitor():
        assert threading.excepthook != before
    assert threading.excepthook == before
