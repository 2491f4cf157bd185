"""Tests of the log of failures that recur."""

from __future__ import annotations

import logging

import pytest

from shared.errors import StoreError
from shared.log_on_change import LogOnChange


def test_failure_is_logged_once_until_it_is_over_or_another(
    caplog: pytest.LogCaptureFixture,
) -> None:
    fault_log = LogOnChange(logging.getLogger("tested"), "the list is old")

    def attempt(*causes: Exception | None) -> None:
        for cause in causes:
            with fault_log:
                if cause is not None:
                    raise cause

    attempt(None, StoreError("full"), StoreError("full"), OSError("gone"), None, None)
    attempt(StoreError("full"))
    assert [one.getMessage() for one in caplog.records] == [
        "the list is old: full",
        "the list is old: gone",
        "over: the list is old",
        "the list is old: full",
    ]
    assert all(one.exc_info is None for one in caplog.records)


def test_error_of_the_program_is_not_suppressed() -> None:
    with pytest.raises(KeyError), LogOnChange(logging.getLogger("tested"), "it failed"):
        raise KeyError


def test_noted_error_of_the_program_is_logged_once_with_its_traceback(
    caplog: pytest.LogCaptureFixture,
) -> None:
    fault_log = LogOnChange(logging.getLogger("tested"), "the list is old")
    for _ in range(2):
        fault_log.note_failure(KeyError("unit"))
    fault_log.note_success()
    assert [(one.getMessage(), one.exc_info is not None) for one in caplog.records] == [
        ("the list is old", True),
        ("over: the list is old", False),
    ]
