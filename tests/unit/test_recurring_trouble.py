"""What goes wrong at every try is told once, and once that it is over."""

from __future__ import annotations

import logging

import pytest

from base_station.program.recurring_trouble import RecurringTrouble
from shared.errors import StoreError


def test_it_is_told_once_until_it_is_over_or_another(caplog: pytest.LogCaptureFixture) -> None:
    trouble = RecurringTrouble(logging.getLogger("tested"), "the list is old")

    def attempt(*causes: Exception | None) -> None:
        for cause in causes:
            with trouble:
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


def test_a_mistake_of_the_program_goes_on_to_who_can_tell_it() -> None:
    with pytest.raises(KeyError), RecurringTrouble(logging.getLogger("tested"), "it failed"):
        raise KeyError
