"""Over real Zenoh: a unit that starts first, a station that restarts, a port that is taken."""

from __future__ import annotations

import threading
import time
from contextlib import closing

import pytest
import zenoh

from base_station.bench.rig.station import free_port
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import Qos
from shared.errors import BusError
from tests.waiting import until


@pytest.fixture
def address() -> str:
    return f"tcp/127.0.0.1:{free_port()}"


def publish_until_heard(unit: ZenohBus, station: ZenohBus, what: str) -> None:
    heard: list[str] = []
    station.subscribe("muster/v1/**", lambda key, _: heard.append(key))

    def arrived() -> bool:
        unit.publish("muster/v1/anna/up/status", b"", Qos.LIVE)
        return bool(heard)

    until(arrived, what)


def test_a_unit_opens_before_its_station_and_finds_it_again_after_a_restart(address: str) -> None:
    with closing(ZenohBus(UnitEndpoint((address,)))) as unit:
        unit.publish("muster/v1/anna/up/status", b"to nobody", Qos.LIVE)
        for start in ("first start", "restart"):
            with closing(ZenohBus(StationEndpoint((address,)))) as station:
                publish_until_heard(unit, station, f"a message after the {start}")


def test_a_closed_bus_leaves_no_thread_that_could_abort_the_program_as_it_ends(
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


def test_a_taken_port_is_said_in_words(address: str) -> None:
    with (
        closing(ZenohBus(StationEndpoint((address,)))),
        pytest.raises(BusError, match=r"another program uses this port.*choose another port"),
    ):
        ZenohBus(StationEndpoint((address,)))


def test_an_address_that_makes_no_sense_is_said_in_words() -> None:
    with pytest.raises(BusError, match="nonsense"):
        ZenohBus(StationEndpoint(("nonsense",)))


def test_a_message_too_large_for_anybody_is_not_taken_and_the_link_stays(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shared.zenoh_settings.MOST_BYTES", 1_000_000)
    heard: list[int] = []
    with (
        closing(ZenohBus(StationEndpoint((address,)))) as station,
        closing(ZenohBus(ClientEndpoint((address,)))) as rogue,
    ):
        station.subscribe("muster/v1/**", lambda _, payload: heard.append(len(payload)))
        until(lambda: rogue.is_heard("muster/v1/anna/up/status"))
        for size in (500_000, 3_000_000, 5):
            rogue._session.put(
                "muster/v1/anna/up/status",
                bytes(size),
                congestion_control=zenoh.CongestionControl.BLOCK,
            )
        until(lambda: 5 in heard)
    assert heard == [500_000, 5]
