"""Search of a unit for its station: the enrolled address first, then announced ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from socket import create_server
from types import SimpleNamespace

import pytest

from base_station.security.pki.folder import PkiFolder
from edge.app import zenoh_station
from edge.app.zenoh_station import ZenohStation
from edge.config import EdgeConfig
from edge.identity import UnitConnection, unit_connection
from shared.bus_memory import MemoryBus, MemoryRouter
from shared.errors import BusError, ConfigError
from shared.zenoh_settings import ClientEndpoint

KNOWN, FOUND, MOVED = "tls/127.0.0.1:1", "tls/127.0.0.1:2", "tls/127.0.0.1:3"


class Network:
    """Stations that answer, those that are announced, and all attempts."""

    def __init__(self) -> None:
        self.announced: tuple[str, ...] = ()
        self.answering: set[str] = set()
        self.tried: list[tuple[str, ...]] = []
        self.searches = 0
        self.now_s = 100.0

    def find(self) -> tuple[str, ...]:
        self.searches += 1
        return self.announced

    def open(self, endpoint: ClientEndpoint) -> MemoryBus:
        self.tried.append(endpoint.connect)
        if endpoint.connect[0] not in self.answering:
            raise BusError("nobody answers")
        return MemoryBus(MemoryRouter(), is_station=False)


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Network:
    network = Network()
    monkeypatch.setattr("shared.bus_zenoh.ZenohBus", network.open)
    clock = SimpleNamespace(monotonic=lambda: network.now_s)  # of the searches alone
    monkeypatch.setattr(zenoh_station, "time", clock)
    return network


@pytest.fixture
def station(network: Network) -> ZenohStation:
    return ZenohStation(UnitConnection("FF-01", (KNOWN,), None, discovers=True), network.find)


def test_enrolled_endpoints_are_tried_before_announced_ones(
    station: ZenohStation, network: Network
) -> None:
    network.announced, network.answering = (FOUND,), {FOUND}
    with pytest.raises(BusError):
        station.open_bus()
    station.open_bus()
    assert network.tried == [(KNOWN, FOUND), (FOUND, KNOWN)]
    assert network.searches == 1  # the second time it was fresh


def test_a_station_that_moved_is_found_again(station: ZenohStation, network: Network) -> None:
    network.announced, network.answering = (KNOWN,), {KNOWN}
    station.open_bus()
    network.announced, network.answering = (MOVED,), {MOVED}
    network.now_s += 20.0
    with pytest.raises(BusError):
        station.open_bus()
    station.open_bus()
    assert network.tried[-1] == (MOVED, KNOWN)
    assert "127.0.0.1 is there but nothing listens on port 3" in station.link_failure_reason()


def test_invented_announcements_take_no_known_station_away(
    station: ZenohStation, network: Network
) -> None:
    network.answering = {KNOWN}
    for port in range(100, 110):
        network.announced = (f"tls/127.0.0.1:{port}",)
        network.now_s += 20.0
        station.open_bus()
    assert {tried[0] for tried in network.tried} == {KNOWN}


def test_unit_without_discovery_sends_no_query(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_station, "_finder", lambda _: pytest.fail("it searches"))
    network.answering = {KNOWN}
    ZenohStation(UnitConnection("FF-01", (KNOWN,), None)).open_bus()
    assert network.tried == [(KNOWN,)]


@pytest.fixture
def listening() -> Iterator[Callable[[], str]]:
    """A place that takes connections."""
    with ExitStack() as stack:

        def listen() -> str:
            taken = stack.enter_context(create_server(("127.0.0.1", 0)))
            return f"tls/127.0.0.1:{taken.getsockname()[1]}"

        yield listen


def test_a_place_that_takes_connections_is_tried_without_a_search(
    network: Network, listening: Callable[[], str]
) -> None:
    known = listening()
    network.answering = {known}
    station = ZenohStation(UnitConnection("FF-01", (known,), None, discovers=True), network.find)
    assert station.is_reachable(30.0)
    station.open_bus()
    assert network.searches == 0
    station.open_bus()  # it was lost at once: somebody else may have taken the place
    assert network.searches == 1


def test_while_the_link_is_lost_what_is_announced_is_probed_too(
    network: Network, listening: Callable[[], str]
) -> None:
    station = ZenohStation(UnitConnection("FF-01", (KNOWN,), None, discovers=True), network.find)
    network.announced = (listening(),)
    assert not station.is_reachable(0.1)
    assert station.is_reachable(30.0)


class TestSettings:
    @pytest.fixture
    def enrolment(self, tmp_path: Path) -> Path:
        pki = PkiFolder(tmp_path)
        pki.create("Test", [], [KNOWN])
        pki.enroll("FF-01").write(tmp_path / "FF-01.toml")
        return tmp_path / "FF-01.toml"

    def test_without_an_enrolment_nothing_is_discovered(self) -> None:
        with pytest.raises(ConfigError, match="only an enrolled unit can discover its station"):
            unit_connection(EdgeConfig("bench:1", unit="FF-01", connect=("discover",)))

    def test_beside_it_stands_what_is_enrolled_or_given(self, enrolment: Path) -> None:
        settings = EdgeConfig("bench:1", enrolment=enrolment, connect=("discover",))
        found = unit_connection(settings)
        assert (found.connect, found.discovers) == ((KNOWN,), True)
        settings = EdgeConfig("bench:1", enrolment=enrolment, connect=(MOVED, "discover"))
        found = unit_connection(settings)
        assert (found.connect, found.discovers) == ((MOVED,), True)

    def test_discovery_is_off_by_default(self, enrolment: Path) -> None:
        assert not unit_connection(EdgeConfig("bench:1", enrolment=enrolment)).discovers
