"""Over real Zenoh: a unit that starts first, a station that restarts, a port that is taken."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress

import pytest
import zenoh

from shared.bus_zenoh import ClientEndpoint, StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import Qos, clock_key
from shared.errors import BusError
from shared.zenoh_settings import MOST_ANSWERED_BYTES, MOST_PUBLISHED_BYTES
from tests.rig.station_process import free_port
from tests.rig.waiting import until


@pytest.fixture
def address() -> str:
    return f"tcp/127.0.0.1:{free_port()}"


def publish_until_received(unit: ZenohBus, station: ZenohBus, what: str) -> None:
    received: list[str] = []
    station.subscribe("muster/v1/**", lambda key, _: received.append(key))

    def arrived() -> bool:
        unit.publish("muster/v1/anna/up/status", b"", Qos.LIVE)
        return bool(received)

    until(arrived, what)


def test_unit_links_with_a_later_and_a_restarted_station(address: str) -> None:
    with closing(ZenohBus(UnitEndpoint((address,)))) as unit:
        unit.publish("muster/v1/anna/up/status", b"to nobody", Qos.LIVE)
        for start in ("first start", "restart"):
            with closing(ZenohBus(StationEndpoint((address,)))) as station:
                publish_until_received(unit, station, f"a message after the {start}")


def test_repeated_key_is_not_sent_again(address: str) -> None:
    """A thin link carries it, and a router would look up way and rights for each message."""
    with (
        closing(ZenohBus(StationEndpoint((address,)))) as station,
        relayed(address) as (through, sent),
        closing(ZenohBus(UnitEndpoint((through,)))) as unit,
    ):
        publish_until_received(unit, station, "a message")
        before = len(sent)
        publish_until_received(unit, station, "another one")
        until(lambda: len(sent) > before, "the relay has noted it")
        assert b"status" in sent[:before]
        assert b"status" not in sent[before:]


@contextmanager
def relayed(address: str) -> Iterator[tuple[str, bytearray]]:
    """Another address for one link to ``address``, and all that comes to it from the far end."""
    host, _, port = address.removeprefix("tcp/").partition(":")
    sent = bytearray()

    def pass_on(source: socket.socket, sink: socket.socket, seen: bytearray) -> None:
        with suppress(OSError):
            while piece := source.recv(65_536):
                seen += piece
                sink.sendall(piece)

    def relay() -> None:
        with listening.accept()[0] as unit, socket.create_connection((host, int(port))) as station:
            back = threading.Thread(target=pass_on, args=(station, unit, bytearray()))
            back.start()
            pass_on(unit, station, sent)
            station.shutdown(socket.SHUT_RDWR)
            back.join()

    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = threading.Thread(target=relay)
        thread.start()
        yield f"tcp/127.0.0.1:{listening.getsockname()[1]}", sent
        thread.join()


def test_closed_bus_leaves_no_thread(
    address: str,
) -> None:
    before = set(threading.enumerate())
    with closing(ZenohBus(StationEndpoint((address,)))) as station:
        kept = station.subscribe("muster/v1/anna/up/**", print)
        station.subscribe("muster/v1/bert/up/**", print).close()
        station.serve("muster/v1/anna/journal", lambda *_: iter(())).close()
        station.serve("muster/v1/bert/journal", lambda *_: iter(()))
        station.ask("muster/v1/bert/journal", b"", 30.0, lambda _: time.sleep(0.2))
        assert set(threading.enumerate()) > before
    assert set(threading.enumerate()) <= before
    kept.close()


def test_port_in_use_is_reported(address: str) -> None:
    with (
        closing(ZenohBus(StationEndpoint((address,)))),
        pytest.raises(BusError, match=r"another program uses this port.*choose another port"),
    ):
        ZenohBus(StationEndpoint((address,)))


def test_invalid_address_is_reported() -> None:
    with pytest.raises(BusError, match="nonsense"):
        ZenohBus(StationEndpoint(("nonsense",)))


def test_foreign_address_is_reported_without_a_source_position() -> None:
    with pytest.raises(BusError, match=r"cannot listen on tcp/192\.0\.2\.1:7447") as refused:
        ZenohBus(StationEndpoint(("tcp/192.0.2.1:7447",)))
    assert ".rs" not in str(refused.value)


def test_oversized_message_is_dropped_and_the_link_stays(address: str) -> None:
    assert sizes_received(address, "muster/stations/v1/a/have", (500_000, 3_000_000, 5)) == [
        500_000,
        5,
    ]


@pytest.mark.parametrize("suffix", ["up/status", "alert/event", "heartbeat"])
def test_message_above_the_size_of_units_is_dropped_by_the_router(
    address: str, suffix: str
) -> None:
    sizes = (MOST_PUBLISHED_BYTES, MOST_PUBLISHED_BYTES + 1, 16_000_000, 5)
    assert sizes_received(address, f"muster/v1/anna/{suffix}", sizes) == [MOST_PUBLISHED_BYTES, 5]


def sizes_received(address: str, key: str, sizes: Sequence[int]) -> list[int]:
    """Sizes of the messages that pass a router, of these, the last of which is small."""
    received: list[int] = []
    with (
        closing(ZenohBus(StationEndpoint((address,)))),
        closing(ZenohBus(ClientEndpoint((address,)))) as station,
        closing(ZenohBus(ClientEndpoint((address,)))) as rogue,
    ):
        station.subscribe("muster/**", lambda _, payload: received.append(len(payload)))
        until(lambda: rogue.has_subscriber(key))
        for size in sizes:
            rogue._session.put(key, bytes(size), congestion_control=zenoh.CongestionControl.BLOCK)
        until(lambda: sizes[-1] in received)
    return received


def test_queries_of_a_unit_are_rate_limited(address: str) -> None:
    key, other = clock_key("evil"), clock_key("anna")
    asked: list[str] = []

    def answer(key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        asked.append(key)
        yield b"now"

    with (
        closing(ZenohBus(StationEndpoint((address,), rate_limited_queries=(key, other)))),
        closing(ZenohBus(ClientEndpoint((address,)))) as station,
        closing(ZenohBus(ClientEndpoint((address,)))) as rogue,
        closing(ZenohBus(ClientEndpoint((address,)))) as unit,
    ):
        station.serve(clock_key("*"), answer)
        until(lambda: list(unit.query(other, b"", 1.0)) == [b"now"])
        for _ in range(500):
            rogue.ask(key, b"", 1.0, lambda _: None)
        time.sleep(0.3)
        assert list(unit.query(other, b"", 1.0)) == [b"now"]
    assert 1 <= asked.count(key) < 50


def test_answer_above_the_size_of_units_is_dropped_by_the_router(address: str) -> None:
    sizes = (MOST_ANSWERED_BYTES, MOST_ANSWERED_BYTES + 1, 5)
    key = "muster/v1/anna/journal/range"
    with (
        closing(ZenohBus(StationEndpoint((address,)))),
        closing(ZenohBus(ClientEndpoint((address,)))) as station,
        closing(ZenohBus(ClientEndpoint((address,)))) as rogue,
    ):
        rogue.serve(key, lambda *_: (bytes(size) for size in sizes))
        received: list[int] = []

        def answered() -> bool:
            received[:] = [len(reply) for reply in station.query(key, b"", 2.0)]
            return bool(received)

        until(answered)
    assert received == [MOST_ANSWERED_BYTES, 5]
