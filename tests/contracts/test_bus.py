"""What every bus promises: one suite over the in-memory bus and over Zenoh on the loopback."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from threading import Event, Thread
from typing import Protocol

import pytest

from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.bus_zenoh import StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import POSITION, Qos, alive_key
from shared.errors import BusError
from tests.station_command import free_port
from tests.waiting import until

KEY = POSITION.key("anna")
ALIVE = alive_key("anna")


class Fabric(Protocol):
    """A station and units on one bus."""

    def station(self) -> Bus: ...

    def unit(self) -> Bus:
        """Returns when the unit is linked to the station."""
        ...


class MemoryFabric:
    def __init__(self) -> None:
        self._router = MemoryRouter()

    def station(self) -> Bus:
        return self._router.attach_station()

    def unit(self) -> Bus:
        return self._router.attach_unit()


class ZenohFabric:
    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._address = f"tcp/127.0.0.1:{free_port()}"
        self._station: ZenohBus | None = None

    def station(self) -> Bus:
        if self._station is None:
            self._station = ZenohBus(StationEndpoint((self._address,)))
            self._stack.callback(self._station.close)
        return self._station

    def unit(self) -> Bus:
        bus = ZenohBus(UnitEndpoint((self._address,)))
        self._stack.callback(bus.close)
        wait_linked(self.station(), bus)
        return bus


def wait_linked(station: Bus, unit: Bus) -> None:
    """Messages and tokens go both ways."""
    heard: list[str] = []
    watch = station.watch_alive("probe/*", lambda key, _: heard.append(key))
    token = unit.declare_alive(f"probe/{id(unit)}")
    until(lambda: bool(heard), "the unit's token at the station")
    echo = unit.subscribe("echo", lambda key, _: heard.append(key))

    def echoed() -> bool:
        station.publish("echo", b"", Qos.LIVE)
        return "echo" in heard

    until(echoed, "the station's message at the unit")
    for declared in (watch, token, echo):
        declared.close()


@dataclass
class Ends:
    station: Bus
    unit: Bus
    fabric: Fabric


@pytest.fixture(params=["memory", "zenoh"])
def ends(request: pytest.FixtureRequest) -> Iterator[Ends]:
    with ExitStack() as stack:
        fabric: Fabric = MemoryFabric() if request.param == "memory" else ZenohFabric(stack)
        station = fabric.station()
        yield Ends(station, fabric.unit(), fabric)


class Heard:
    """A handler that remembers."""

    def __init__(self) -> None:
        self.samples: list[tuple[str, bytes]] = []

    def __call__(self, key: str, payload: bytes) -> None:
        self.samples.append((key, payload))

    def has(self, count: int) -> bool:
        return len(self.samples) >= count


def publish_until_heard(publisher: Bus, key: str, heard: Heard) -> None:
    """A subscription takes a moment to reach the other side; then it stands."""

    def arrived() -> bool:
        publisher.publish(key, b"probe", Qos.LIVE)
        return any(sample[0] == key for sample in heard.samples)

    until(arrived, f"a first message under {key}")
    publisher.publish(key, b"end of probes", Qos.LIVE)
    until(lambda: (key, b"end of probes") in heard.samples, "the last probe")
    heard.samples.clear()


@pytest.mark.parametrize("qos", [Qos.LIVE, Qos.ALERT])
def test_messages_arrive_once_whole_and_in_order(ends: Ends, qos: Qos) -> None:
    heard = Heard()
    ends.station.subscribe("muster/v1/*/up/**", heard)
    publish_until_heard(ends.unit, KEY, heard)
    sent = [(KEY, number.to_bytes(2, "big") * number) for number in range(300)]
    for begin in range(0, len(sent), 2):
        # Faster than the link takes them, messages are dropped: the journal brings those.
        for key, payload in sent[begin : begin + 2]:
            ends.unit.publish(key, payload, qos)
        until(partial(heard.has, begin + 2), "the messages so far")
    assert heard.samples == sent


def test_the_station_reaches_a_unit(ends: Ends) -> None:
    heard = Heard()
    ends.unit.subscribe("muster/v1/anna/command/**", heard)
    publish_until_heard(ends.station, "muster/v1/anna/command/send", heard)
    ends.station.publish("muster/v1/ben/command/send", b"not hers", Qos.ALERT)
    ends.station.publish("muster/v1/anna/command/send", b"evacuate", Qos.ALERT)
    until(lambda: bool(heard.samples), "the command")
    assert heard.samples == [("muster/v1/anna/command/send", b"evacuate")]


def test_units_do_not_hear_each_other(ends: Ends) -> None:
    ben = ends.fabric.unit()
    at_station, at_ben = Heard(), Heard()
    ends.station.subscribe("muster/v1/**", at_station)
    ben.subscribe("muster/v1/**", at_ben)
    publish_until_heard(ends.station, "muster/v1/all/command/send", at_ben)
    publish_until_heard(ends.unit, KEY, at_station)
    assert KEY not in [key for key, _ in at_ben.samples]


@pytest.mark.parametrize(
    ("expression", "matches"),
    [
        ("muster/v1/anna/up/position", True),
        ("muster/v1/*/up/position", True),
        ("muster/v1/**", True),
        ("**", True),
        ("**/position", True),
        ("muster/**/up/**", True),
        ("muster/v1/anna/up/position/**", True),
        ("muster/v1/*/position", False),
        ("muster/v1/ann/up/position", False),
        ("muster/v1/*", False),
        ("*/up/position", False),
    ],
)
def test_key_expressions_select_as_in_zenoh(ends: Ends, expression: str, matches: bool) -> None:
    selected, everything = Heard(), Heard()
    ends.station.subscribe(expression, selected)
    ends.station.subscribe("muster/v1/*/up/*", everything)
    publish_until_heard(ends.unit, KEY, everything)
    until(lambda: bool(selected.samples) or not matches, "the selected message")
    assert bool(selected.samples) is matches


def test_after_close_a_subscription_hears_nothing(ends: Ends) -> None:
    closed, still_open = Heard(), Heard()
    subscription = ends.station.subscribe("muster/v1/**", closed)
    ends.station.subscribe("muster/v1/**", still_open)
    publish_until_heard(ends.unit, KEY, still_open)
    subscription.close()
    closed.samples.clear()
    ends.unit.publish(KEY, b"after", Qos.LIVE)
    until(lambda: (KEY, b"after") in still_open.samples, "the message after closing")
    assert closed.samples == []


def test_closing_waits_for_a_call_under_way(ends: Ends) -> None:
    entered, leave = Event(), Event()
    calls: list[str] = []

    def slow(key: str, payload: bytes) -> None:
        entered.set()
        leave.wait(20.0)
        calls.append(key)

    subscription = ends.unit.subscribe(KEY, slow)
    publisher = Thread(target=ends.unit.publish, args=(KEY, b"", Qos.LIVE))
    publisher.start()
    assert entered.wait(20.0)
    closer = Thread(target=subscription.close)
    closer.start()
    assert closer.is_alive()
    leave.set()
    closer.join()
    assert calls == [KEY]
    publisher.join()


def test_a_failing_handler_is_logged_once_and_stops_nothing(
    ends: Ends, caplog: pytest.LogCaptureFixture
) -> None:
    heard = Heard()

    def failing(key: str, payload: bytes) -> None:
        raise ValueError("a bug")

    ends.station.subscribe("muster/v1/**", failing)
    ends.station.subscribe("muster/v1/**", heard)
    with caplog.at_level(logging.ERROR):
        publish_until_heard(ends.unit, KEY, heard)
        ends.unit.publish(KEY, b"later", Qos.LIVE)
        until(lambda: bool(heard.samples), "a message beside a failing handler")
    assert [record.exc_info is not None for record in caplog.records] == [True]


def test_tokens_appear_and_vanish(ends: Ends) -> None:
    told: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: told.append((key, alive)))
    token = ends.unit.declare_alive(ALIVE)
    until(lambda: told == [(ALIVE, True)], "the token")
    token.close()
    until(lambda: told == [(ALIVE, True), (ALIVE, False)], "the end of the token")


def test_a_late_watcher_hears_of_tokens_that_are_there(ends: Ends) -> None:
    early: list[str] = []
    late: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, _: early.append(key))
    _token = ends.unit.declare_alive(ALIVE)
    until(lambda: early == [ALIVE], "the token")
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: late.append((key, alive)))
    until(lambda: late == [(ALIVE, True)], "the token that was there")


def test_a_unit_that_closes_takes_its_token_along(ends: Ends) -> None:
    told: list[tuple[str, bool]] = []
    ends.station.watch_alive("muster/v1/*/alive", lambda key, alive: told.append((key, alive)))
    _token = ends.unit.declare_alive(ALIVE)
    until(lambda: told == [(ALIVE, True)], "the token")
    ends.unit.close()
    until(lambda: told == [(ALIVE, True), (ALIVE, False)], "the end of the token")


def test_queries_are_answered_in_order(ends: Ends) -> None:
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


def test_a_query_without_anyone_to_answer_yields_nothing(ends: Ends) -> None:
    assert list(ends.station.query("muster/v1/nobody/journal", b"", 0.5)) == []


@pytest.mark.parametrize("urgent", [False, True])
def test_what_is_asked_without_waiting_is_answered_in_order_and_ended_once(
    ends: Ends, urgent: bool
) -> None:
    ends.unit.serve("muster/v1/anna/journal", lambda *_: (b"%d" % n for n in range(100)))
    heard: list[bytes | None] = []

    def answered() -> bool:
        heard.clear()
        ends.station.ask("muster/v1/anna/journal", b"", 10.0, heard.append, urgent=urgent)
        until(lambda: None in heard, "the end of the replies")
        return len(heard) > 1

    until(answered, "replies")
    assert heard == [*(b"%d" % n for n in range(100)), None]


def test_what_nobody_answers_ends_all_the_same(ends: Ends) -> None:
    heard: list[bytes | None] = []
    ends.station.ask("muster/v1/nobody/journal", b"", 0.5, heard.append)
    until(lambda: bool(heard), "the end of the replies")
    assert heard == [None]


def test_a_query_handler_that_fails_answers_nothing(
    ends: Ends, caplog: pytest.LogCaptureFixture
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


def test_one_knows_whether_anybody_else_listens(ends: Ends) -> None:
    ends.unit.subscribe("muster/v1/anna/command/**", Heard())
    assert not ends.unit.is_heard(KEY)
    listening = ends.station.subscribe("muster/v1/*/up/**", Heard())
    until(lambda: ends.unit.is_heard(KEY), "the station's interest")
    assert not ends.unit.is_heard(ALIVE)
    listening.close()
    until(lambda: not ends.unit.is_heard(KEY), "the end of the station's interest")
    ends.unit.close()
    assert not ends.unit.is_heard(KEY)


@pytest.mark.parametrize("key", ["a//b", "/a", "a/", "a/*", "a/**", "a?b", "a#b", ""])
def test_a_key_that_cannot_be_published_under_is_refused(ends: Ends, key: str) -> None:
    with pytest.raises(BusError, match="not a key"):
        ends.unit.publish(key, b"", Qos.LIVE)


@pytest.mark.parametrize("expression", ["a//b", "", "a/b*", "a?b"])
def test_a_key_expression_that_selects_nothing_is_refused(ends: Ends, expression: str) -> None:
    with pytest.raises(BusError, match="not a key expression"):
        ends.unit.subscribe(expression, Heard())


def test_what_is_the_stations_own_never_travels(ends: Ends) -> None:
    with pytest.raises(BusError, match="never travels"):
        ends.unit.publish("muster/v1/station/tick", b"", Qos.LOCAL)


def test_a_closed_bus_says_so(ends: Ends) -> None:
    ends.unit.close()
    with pytest.raises(BusError, match="closed"):
        ends.unit.publish(KEY, b"", Qos.LIVE)
    ends.unit.close()


def test_a_linked_end_knows_it_until_it_closes(ends: Ends) -> None:
    assert ends.unit.is_linked()
    assert ends.station.is_linked()
    ends.unit.close()
    assert not ends.unit.is_linked()


def test_a_handler_may_close_its_own_subscription(ends: Ends) -> None:
    heard, once = Heard(), Heard()

    def close_after_one(key: str, payload: bytes) -> None:
        once(key, payload)
        subscription.close()

    subscription = ends.station.subscribe(KEY, close_after_one)
    ends.station.subscribe(KEY, heard)
    publish_until_heard(ends.unit, KEY, heard)
    ends.unit.publish(KEY, b"later", Qos.LIVE)
    until(lambda: bool(heard.samples), "a message after closing")
    assert len(once.samples) == 1
