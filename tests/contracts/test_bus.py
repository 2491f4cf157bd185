"""Contract of messages of every bus: over the in-memory bus and over Zenoh on the loopback."""

from __future__ import annotations

import logging
from functools import partial
from threading import Event, Thread

import pytest

from shared.channels import POSITION, Qos
from shared.errors import BusError
from tests.rig.bus_ends import BusEnds, ReceivedMessages, publish_until_received
from tests.rig.waiting import until

KEY = POSITION.key("anna")


@pytest.mark.parametrize("qos", [Qos.LIVE, Qos.ALERT])
def test_messages_arrive_once_complete_and_in_order(ends: BusEnds, qos: Qos) -> None:
    """Each is sent when the one before has arrived: the link has room, and none may be dropped."""
    received = ReceivedMessages()
    ends.station.subscribe("muster/v1/*/up/**", received)
    publish_until_received(ends.unit, KEY, received)
    sent = [(KEY, number.to_bytes(2, "big") * number) for number in range(300)]
    for count, (key, payload) in enumerate(sent, 1):
        ends.unit.publish(key, payload, qos)
        until(partial(received.has, count), f"message {count}", poll_interval_s=0.002)
    assert received.samples == sent


@pytest.mark.parametrize("qos", [Qos.LIVE, Qos.ALERT])
def test_messages_of_a_burst_arrive_once_complete_and_in_order(ends: BusEnds, qos: Qos) -> None:
    """Faster than the link, whole messages are dropped: the journal brings those."""
    received = ReceivedMessages()
    ends.station.subscribe("muster/v1/*/up/**", received)
    publish_until_received(ends.unit, KEY, received)
    sent = [(KEY, number.to_bytes(2, "big") * number) for number in range(1, 301)]
    for key, payload in sent:
        ends.unit.publish(key, payload, qos)
    end = (KEY, b"end of the burst")

    def has_ended() -> bool:
        ends.unit.publish(*end, qos)
        return end in received.samples

    until(has_ended, "a message after the burst")
    arrived = [one for one in received.samples if one != end]
    assert sent[0] in arrived
    assert arrived == [one for one in sent if one in arrived]


def test_the_station_reaches_a_unit(ends: BusEnds) -> None:
    received = ReceivedMessages()
    ends.unit.subscribe("muster/v1/anna/command/**", received)
    publish_until_received(ends.station, "muster/v1/anna/command/send", received)
    ends.station.publish("muster/v1/ben/command/send", b"not hers", Qos.ALERT)
    ends.station.publish("muster/v1/anna/command/send", b"evacuate", Qos.ALERT)
    until(lambda: bool(received.samples), "the command")
    assert received.samples == [("muster/v1/anna/command/send", b"evacuate")]


def test_local_key_is_not_delivered_to_its_publisher(ends: BusEnds) -> None:
    own, at_station = ReceivedMessages(), ReceivedMessages()
    ends.unit.subscribe(KEY, own)
    ends.station.subscribe(KEY, at_station)
    publish_until_received(ends.unit, KEY, at_station)
    ends.unit.publish(KEY, b"for others", Qos.LIVE, remote_only=True)
    ends.unit.publish(KEY, b"for all", Qos.LIVE)
    until(lambda: (KEY, b"for all") in own.samples, "its own")
    until(partial(at_station.has, 2), "both")
    assert (KEY, b"for others") not in own.samples
    assert [payload for _, payload in at_station.samples] == [b"for others", b"for all"]


def test_units_do_not_receive_each_other(ends: BusEnds) -> None:
    ben = ends.fabric.unit()
    at_station, at_ben = ReceivedMessages(), ReceivedMessages()
    ends.station.subscribe("muster/v1/**", at_station)
    ben.subscribe("muster/v1/**", at_ben)
    publish_until_received(ends.station, "muster/v1/all/command/send", at_ben)
    publish_until_received(ends.unit, KEY, at_station)
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
def test_key_expressions_select_as_in_zenoh(ends: BusEnds, expression: str, matches: bool) -> None:
    selected, everything = ReceivedMessages(), ReceivedMessages()
    ends.station.subscribe(expression, selected)
    ends.station.subscribe("muster/v1/*/up/*", everything)
    publish_until_received(ends.unit, KEY, everything)
    until(lambda: bool(selected.samples) or not matches, "the selected message")
    assert bool(selected.samples) is matches


def test_after_close_a_subscription_receives_nothing(ends: BusEnds) -> None:
    closed, still_open = ReceivedMessages(), ReceivedMessages()
    subscription = ends.station.subscribe("muster/v1/**", closed)
    ends.station.subscribe("muster/v1/**", still_open)
    publish_until_received(ends.unit, KEY, still_open)
    subscription.close()
    closed.samples.clear()
    ends.unit.publish(KEY, b"after", Qos.LIVE)
    until(lambda: (KEY, b"after") in still_open.samples, "the message after closing")
    assert closed.samples == []


def test_closing_waits_for_a_call_under_way(ends: BusEnds) -> None:
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
    ends: BusEnds, caplog: pytest.LogCaptureFixture
) -> None:
    received = ReceivedMessages()
    failed: list[str] = []

    def failing(key: str, payload: bytes) -> None:
        failed.append(key)
        raise ValueError("a bug")

    ends.station.subscribe("muster/v1/**", failing)
    ends.station.subscribe("muster/v1/**", received)
    with caplog.at_level(logging.ERROR):
        publish_until_received(ends.unit, KEY, received)
        ends.unit.publish(KEY, b"later", Qos.LIVE)
        until(lambda: bool(received.samples), "a message beside a failing handler")
        until(lambda: len(failed) > 1, "it has failed again")  # each handler has its own thread
    assert [record.exc_info is not None for record in caplog.records] == [True]


@pytest.mark.parametrize("key", ["a//b", "/a", "a/", "a/*", "a/**", "a?b", "a#b", ""])
def test_key_that_cannot_be_published_under_is_refused(ends: BusEnds, key: str) -> None:
    with pytest.raises(BusError, match="not a key"):
        ends.unit.publish(key, b"", Qos.LIVE)


@pytest.mark.parametrize("expression", ["a//b", "", "a/b*", "a?b"])
def test_key_expression_that_selects_nothing_is_refused(ends: BusEnds, expression: str) -> None:
    with pytest.raises(BusError, match="not a key expression"):
        ends.unit.subscribe(expression, ReceivedMessages())


def test_local_messages_of_the_station_never_travel(ends: BusEnds) -> None:
    with pytest.raises(BusError, match="never travels"):
        ends.unit.publish("muster/v1/station/tick", b"", Qos.LOCAL)


def test_closed_bus_raises(ends: BusEnds) -> None:
    ends.unit.close()
    with pytest.raises(BusError, match="closed"):
        ends.unit.publish(KEY, b"", Qos.LIVE)
    ends.unit.close()


def test_a_handler_may_close_its_own_subscription(ends: BusEnds) -> None:
    received, once = ReceivedMessages(), ReceivedMessages()

    def close_after_one(key: str, payload: bytes) -> None:
        once(key, payload)
        subscription.close()

    subscription = ends.station.subscribe(KEY, close_after_one)
    ends.station.subscribe(KEY, received)
    publish_until_received(ends.unit, KEY, received)
    ends.unit.publish(KEY, b"later", Qos.LIVE)
    until(lambda: bool(received.samples), "a message after closing")
    assert len(once.samples) == 1
