"""Contract of liveliness tokens and queries of every bus."""

from __future__ import annotations

import logging
from collections.abc import Iterable

import pytest

from shared.channels import POSITION, alive_key
from tests.rig.bus_ends import BusEnds, ReceivedMessages
from tests.rig.waiting import until

KEY = POSITION.key("anna")
ALIVE = alive_key("anna")


def test_tokens_appear_and_vanish(ends: BusEnds) -> None:
    reported: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: reported.append((key, alive)))
    token = ends.unit.declare_alive(ALIVE)
    until(lambda: reported == [(ALIVE, True)], "the token")
    token.close()
    until(lambda: reported == [(ALIVE, True), (ALIVE, False)], "the end of the token")


def test_late_watcher_receives_existing_tokens(ends: BusEnds) -> None:
    early: list[str] = []
    late: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, _: early.append(key))
    _token = ends.unit.declare_alive(ALIVE)
    until(lambda: early == [ALIVE], "the token")
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: late.append((key, alive)))
    until(lambda: late == [(ALIVE, True)], "the token that was there")


def test_token_ends_when_its_unit_closes(ends: BusEnds) -> None:
    reported: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: reported.append((key, alive)))
    _token = ends.unit.declare_alive(ALIVE)
    until(lambda: reported == [(ALIVE, True)], "the token")
    ends.unit.close()
    until(lambda: reported == [(ALIVE, True), (ALIVE, False)], "the end of the token")


def test_queries_are_answered_in_order(ends: BusEnds) -> None:
    asked: list[tuple[str, str, bytes]] = []

    def journal(key: str, parameters: str, payload: bytes) -> Iterable[bytes]:
        asked.append((key, parameters, payload))
        return (number.to_bytes(4, "big") for number in range(700))

    ends.unit.serve("muster/v1/anna/journal", journal)
    replies: list[bytes] = []

    def answered() -> bool:
        replies[:] = ends.station.query("muster/v1/anna/journal?from=1;to=9", b"why", 10.0)
        return bool(replies)

    until(answered, "replies")
    assert replies == [number.to_bytes(4, "big") for number in range(700)]
    assert asked[-1] == ("muster/v1/anna/journal", "from=1;to=9", b"why")


def test_query_without_answerer_yields_nothing(ends: BusEnds) -> None:
    assert list(ends.station.query("muster/v1/nobody/journal", b"", 0.5)) == []


@pytest.mark.parametrize("urgent", [False, True])
def test_asynchronous_query_is_answered_in_order_and_ended_once(
    ends: BusEnds, urgent: bool
) -> None:
    ends.unit.serve("muster/v1/anna/journal", lambda *_: (b"%d" % n for n in range(100)))
    received: list[bytes | None] = []

    def answered() -> bool:
        received.clear()
        ends.station.ask("muster/v1/anna/journal", b"", 10.0, received.append, urgent=urgent)
        until(lambda: None in received, "the end of the replies")
        return len(received) > 1

    until(answered, "replies")
    assert received == [*(b"%d" % n for n in range(100)), None]


def test_unanswered_asynchronous_query_ends(ends: BusEnds) -> None:
    received: list[bytes | None] = []
    ends.station.ask("muster/v1/nobody/journal", b"", 0.5, received.append)
    until(lambda: bool(received), "the end of the replies")
    assert received == [None]


def test_failing_query_handler_answers_nothing(
    ends: BusEnds, caplog: pytest.LogCaptureFixture
) -> None:
    def failing(key: str, parameters: str, payload: bytes) -> Iterable[bytes]:
        yield b"first"
        raise ValueError("a bug")

    ends.unit.serve("muster/v1/anna/journal", failing)
    replies: list[bytes] = []

    def answered() -> bool:
        replies[:] = ends.station.query("muster/v1/anna/journal", b"", 10.0)
        return bool(replies)

    with caplog.at_level(logging.ERROR):
        until(answered, "what came before the failure")
    assert replies == [b"first"]
    assert len(caplog.records) == 1


def test_publisher_detects_other_subscribers(ends: BusEnds) -> None:
    ends.unit.subscribe("muster/v1/anna/command/**", ReceivedMessages())
    assert not ends.unit.has_subscriber(KEY)
    listening = ends.station.subscribe("muster/v1/*/up/**", ReceivedMessages())
    until(lambda: ends.unit.has_subscriber(KEY), "the station's interest")
    assert not ends.unit.has_subscriber(ALIVE)
    listening.close()
    until(lambda: not ends.unit.has_subscriber(KEY), "the end of the station's interest")
    ends.unit.close()
    assert not ends.unit.has_subscriber(KEY)


def test_linked_end_reports_its_link_until_it_closes(ends: BusEnds) -> None:
    assert ends.unit.is_linked()
    assert ends.station.is_linked()
    ends.unit.close()
    assert not ends.unit.is_linked()
