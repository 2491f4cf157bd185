"""A program ends at any number of signals, at any time."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest

from shared.end_signals import end_requested


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_during_a_check_is_received(number: signal.Signals) -> None:
    """Two presses of Ctrl-C, or one in the instant in which the main thread holds the lock."""
    stop = end_requested()
    assert not stop.is_set()
    with stop._cond:  # type: ignore[attr-defined]  # as it does for an instant in every wait
        signal.raise_signal(number)
        signal.raise_signal(number)
    assert stop.wait(10.0)
