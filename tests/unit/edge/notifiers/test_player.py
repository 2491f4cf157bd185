"""Notices are played in turn, urgent ones at once, and a failing output is reported."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import closing
from functools import partial

import pytest

from edge.notifiers.player import NoticePlayer
from edge.notifiers.signals import Notice, Signal
from tests.rig.waiting import PATIENCE_S, until

EVACUATE = Notice(Signal.EVACUATE, "c1")
TEXT = Notice(Signal.TEXT, "c2", "come out")
PAR = Notice(Signal.PAR_REQUEST, "c3")
BATTERY = Notice(Signal.BATTERY_LOW)


class Output:
    """Notes what is played; plays for as long as it is made to."""

    def __init__(self) -> None:
        self.begun: list[Notice] = []
        self.interrupted: list[Notice] = []
        self.hold = threading.Event()
        self.hold.set()
        self.failure: OSError | None = None
        self.failures = 0
        self.is_closed = False

    def play(self, notice: Notice, interrupt: threading.Event) -> None:
        if self.failure is not None:
            self.failures += 1
            raise self.failure
        self.begun.append(notice)
        while not self.hold.is_set():
            if interrupt.wait(0.005):
                self.interrupted.append(notice)
                return
        interrupt.wait(0.005)

    def close(self) -> None:
        self.is_closed = True


@pytest.fixture
def output() -> Output:
    return Output()


@pytest.fixture
def player(output: Output) -> Iterator[NoticePlayer]:
    with closing(NoticePlayer("led:red", output)) as player:
        player.start()
        yield player


def test_shown_notice_is_repeated_and_reported_once(player, output) -> None:
    player.show((EVACUATE,))
    until(lambda: output.begun.count(EVACUATE) > 3)
    assert player.take_played() == (EVACUATE,)
    assert player.take_played() == ()
    player.show(())
    until(lambda: player._playing is None)
    assert player._next() is None


def test_a_notice_that_is_stated_once_is_played_once_as_long_as_it_is_shown(player, output) -> None:
    player.show((BATTERY,))
    until(lambda: player.take_played() == (BATTERY,))
    player.show((BATTERY, EVACUATE))
    until(lambda: output.begun.count(EVACUATE) > 3)
    assert output.begun.count(BATTERY) == 1
    player.show(())
    player.show((BATTERY,))
    until(lambda: output.begun.count(BATTERY) == 2)


def test_the_urgent_interrupts_and_nothing_is_hidden_by_it(player, output) -> None:
    output.hold.clear()
    player.show((TEXT,))
    until(lambda: output.begun == [TEXT])
    player.show((EVACUATE, TEXT))
    until(lambda: output.begun == [TEXT, EVACUATE])
    assert output.interrupted == [TEXT]
    assert player.take_played() == ()
    player.show((EVACUATE, PAR, TEXT))
    output.hold.set()
    until(lambda: {PAR, TEXT} <= set(output.begun[2:]))
    until(lambda: output.begun.count(EVACUATE) > 3)
    assert output.interrupted == [TEXT], "what is less urgent waits for its turn"
    assert output.begun.count(PAR) == 1, "it is repeated after its pause"


def test_an_urgent_notice_begins_within_a_tenth_of_a_second(player, output) -> None:
    output.hold.clear()
    player.show((TEXT,))
    until(lambda: output.begun == [TEXT])
    latencies_s = []

    def has_begun(number: str) -> bool:
        return bool(output.begun[-1].key == number)

    for number in map(str, range(5)):
        begun_s = time.monotonic()
        player.show((Notice(Signal.PRE_ALERT, number), TEXT))
        until(partial(has_begun, number))
        latencies_s.append(time.monotonic() - begun_s)
    assert min(latencies_s) < 0.1, latencies_s


def test_an_output_that_fails_is_reported_once_and_tried_again(
    player, output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("edge.notifiers.player._RETRY_S", 0.01)
    output.failure = OSError(5, "Input/output error")
    player.show((EVACUATE,))
    faults: list[str] = []

    def has_failed() -> bool:
        faults.extend(player.take_faults())
        return bool(faults)

    until(has_failed)
    until(lambda: output.failures > 5)
    assert [*faults, *player.take_faults()] == [
        "output led:red: it does not answer (input/output error); check its wires and its supply"
    ]
    assert player.take_played() == ()
    output.failure = None
    until(lambda: player.take_played() == (EVACUATE,))


def test_stopped_player_ends_at_once_with_a_silent_output(output) -> None:
    output.hold.clear()
    player = NoticePlayer("led:red", output)
    player.start()
    player.show((EVACUATE,))
    until(lambda: output.begun == [EVACUATE])
    begun_s = time.monotonic()
    player.close()
    assert output.is_closed
    assert time.monotonic() - begun_s < PATIENCE_S
