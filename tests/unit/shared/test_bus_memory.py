"""The in-memory bus: links that a test cuts, and a fixed order of events."""

from __future__ import annotations

from shared.bus_memory import MemoryRouter
from shared.channels import Qos


def test_without_a_link_what_is_published_is_gone() -> None:
    router = MemoryRouter()
    station, unit = router.attach_station(), router.attach_unit()
    received: list[bytes] = []
    station.subscribe("**", lambda _, payload: received.append(payload))
    unit.link_down()
    unit.publish("a", b"lost", Qos.LIVE)
    unit.link_up()
    unit.publish("a", b"heard", Qos.LIVE)
    assert received == [b"heard"]


def test_an_unlinked_endpoint_still_receives_itself() -> None:
    unit = MemoryRouter().attach_unit()
    received: list[bytes] = []
    unit.subscribe("**", lambda _, payload: received.append(payload))
    unit.link_down()
    unit.publish("a", b"own", Qos.LIVE)
    assert received == [b"own"]


def test_tokens_vanish_and_return_with_the_link_on_both_sides() -> None:
    router = MemoryRouter()
    station, unit = router.attach_station(), router.attach_unit()
    station.declare_alive("station/alive")
    unit.declare_alive("unit/alive")
    at_station: list[tuple[str, bool]] = []
    at_unit: list[tuple[str, bool]] = []
    station.watch_alive("unit/*", lambda key, alive: at_station.append((key, alive)))
    unit.watch_alive("station/*", lambda key, alive: at_unit.append((key, alive)))
    unit.link_down()
    unit.link_up()
    assert at_station == [("unit/alive", True), ("unit/alive", False), ("unit/alive", True)]
    assert at_unit == [("station/alive", True), ("station/alive", False), ("station/alive", True)]


def test_an_unlinked_unit_answers_no_query() -> None:
    router = MemoryRouter()
    station, unit = router.attach_station(), router.attach_unit()
    unit.serve("journal", lambda *_: [b"reply"])
    assert list(station.query("journal", b"", 1.0)) == [b"reply"]
    unit.link_down()
    assert list(station.query("journal", b"", 1.0)) == []


def test_a_pumped_router_delivers_only_when_reported_in_the_order_of_publishing() -> None:
    router = MemoryRouter(pumped=True)
    station, anna, ben = router.attach_station(), router.attach_unit(), router.attach_unit()
    received: list[bytes] = []
    station.subscribe("**", lambda _, payload: received.append(payload))
    ben.publish("a", b"1", Qos.LIVE)
    anna.publish("a", b"2", Qos.ALERT)
    assert received == []
    assert router.pump() == 2
    assert received == [b"1", b"2"]
    assert router.pump() == 0


def test_message_published_by_a_handler_follows_those_in_delivery() -> None:
    router = MemoryRouter()
    station, unit = router.attach_station(), router.attach_unit()
    received: list[str] = []

    def answer(key: str, _: bytes) -> None:
        received.append(f"first {key}")
        if key == "question":
            station.publish("answer", b"", Qos.LIVE)

    station.subscribe("**", answer)
    station.subscribe("**", lambda key, _: received.append(f"second {key}"))
    unit.publish("question", b"", Qos.LIVE)
    assert received == ["first question", "second question", "first answer", "second answer"]
