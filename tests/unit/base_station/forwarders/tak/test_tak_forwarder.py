"""The connection to TAK: servers that are away, close, stall, send rubbish, and come back."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from threading import Event, Thread

import pytest

from base_station.forwarders.registry import FORWARDERS
from base_station.forwarders.running import Forwarders, make_forwarders
from base_station.forwarders.tak.config import TakConfig
from base_station.forwarders.tak.forwarder import TakForwarder
from shared.clock import ManualClock, SystemClock
from tests.rig.cot_schema import check_event
from tests.rig.forwarder_surroundings import surroundings
from tests.rig.station_process import free_port
from tests.rig.tak_scene import Scene, alarm, delta
from tests.rig.waiting import until

pytestmark = pytest.mark.slow
_END = b"</event>"


class FakeServer:
    """Listens on a port; ``received`` has all received bytes, by connection."""

    def __init__(self, port: int = 0, behave: Callable[[socket.socket], object] | None = None):
        self.received: list[bytes] = []
        self._behave = behave
        self._listening = socket.create_server(("127.0.0.1", port))
        self.port = int(self._listening.getsockname()[1])
        self._connected: list[socket.socket] = []
        self._thread = Thread(target=self._accept, daemon=True)
        self._thread.start()

    def _accept(self) -> None:
        while True:
            try:
                connected, _ = self._listening.accept()
            except OSError:
                return
            self._connected.append(connected)
            if self._behave is not None:
                self._behave(connected)
                self.received.append(b"")
            else:
                self.received.append(b"")
                Thread(target=self._read, args=(connected, len(self.received) - 1)).start()

    def _read(self, connected: socket.socket, number: int) -> None:
        while True:
            try:
                data = connected.recv(65_536)
            except OSError:
                return
            if not data:
                return
            self.received[number] += data

    def send(self, data: bytes) -> None:
        self._connected[-1].sendall(data)

    def hang_up(self) -> None:
        self._connected[-1].shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        for connected in self._connected:
            connected.close()
        self._thread.join()


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def forwarder_to(
    port: int, closing: ExitStack, leads: Callable[[], bool] = lambda: True, **settings: float
) -> TakForwarder:
    config = TakConfig(f"tcp://127.0.0.1:{port}", **settings)  # type: ignore[arg-type]  # floats
    forwarder = TakForwarder("county", config, surroundings(SystemClock(), leads))
    closing.callback(forwarder.close)
    return forwarder


def serve(closing: ExitStack, port: int = 0, **behaviour: Callable[[socket.socket], object]):
    server = FakeServer(port, **behaviour)
    closing.callback(server.close)
    return server


def uids(data: bytes) -> list[str]:
    return [check_event(one + _END).get("uid", "") for one in data.split(_END)[:-1]]


def test_state_known_before_the_connection_is_sent_with_it(closing: ExitStack) -> None:
    server = serve(closing)
    forwarder = forwarder_to(server.port, closing)
    forwarder.reset(Scene("FF-01", "FF-02").picture(alarms=(alarm(),)))
    forwarder.start()
    until(lambda: len(server.received) == 1 and len(uids(server.received[0])) == 3, "three")
    assert uids(server.received[0])[0] == "muster.FF-01-9-1-1", "the emergency first"
    until(lambda: forwarder.view().sent == 3, "they are counted")
    assert (forwarder.view().state, forwarder.view().text) == ("connected", "")


def test_returning_server_gets_the_present_positions(closing: ExitStack) -> None:
    scene, port = Scene(), free_port()
    forwarder = forwarder_to(port, closing)
    forwarder.reset(scene.picture())
    forwarder.start()
    until(lambda: "cannot be reached" in forwarder.view().text, "it is away")
    for step in range(50):
        forwarder.delta(delta(scene.moved(float(step), float(step))))
    server = serve(closing, port)
    until(lambda: server.received and uids(server.received[0]), "the newest comes")
    first = check_event(server.received[0].split(_END)[0] + _END)
    assert float(first[0].get("lat", "")) > 52.5004, "of the last step, and not of those before"
    server.hang_up()
    until(lambda: len(server.received) == 2 and uids(server.received[1]), "it comes again")


def test_server_that_closes_at_once_is_retried_less_and_less_often(closing: ExitStack) -> None:
    server = serve(closing, behave=lambda connected: connected.close())
    forwarder = forwarder_to(server.port, closing)
    forwarder.reset(Scene().picture())
    forwarder.start()
    until(lambda: len(server.received) >= 2, "it is tried again")
    assert forwarder._retry_s > 1.0
    until(lambda: forwarder.view().state == "connecting", "it is closed again")


def test_rubbish_from_a_server_changes_nothing(closing: ExitStack) -> None:
    server = serve(closing)
    forwarder = forwarder_to(server.port, closing)
    scene = Scene()
    forwarder.reset(scene.picture())
    forwarder.start()
    until(lambda: server.received and uids(server.received[0]), "it is connected")
    server.send(b"\x00\xff<!DOCTYPE a [<!ENTITY b 'c'>]>" * 5000 + b"<event" * 10_000)
    forwarder.delta(delta(scene.moved(5.0, 60.0)))
    until(lambda: len(uids(server.received[0])) >= 2, "it goes on")
    assert len(server.received) == 1


def test_server_that_reads_nothing_takes_bounded_memory_and_is_disconnected(
    closing: ExitStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.forwarders.tak.connection._DRAIN_S", 1.0)
    stalled = Event()
    server = serve(closing, behave=lambda _: stalled.set())
    names = [f"FF-{number:03}" for number in range(200)]
    scene = Scene(*names)
    forwarder = forwarder_to(server.port, closing, every_s=0.2)
    forwarder.reset(scene.picture())
    forwarder.start()
    assert stalled.wait(60.0)
    reported = 0

    def is_left() -> bool:
        nonlocal reported
        reported += 1
        forwarder.delta(delta(*(scene.moved(1.0, 10.0 + reported, one) for one in names)))
        return "takes nothing" in forwarder.view().text or len(server.received) > 1

    until(is_left, "it is left")


def test_long_lost_connection_is_a_problem_until_it_is_back(closing: ExitStack) -> None:
    clock = ManualClock()
    config = TakConfig("tcp://127.0.0.1:9", alarm_after_s=60.0)
    forwarder = TakForwarder("county", config, surroundings(clock))
    forwarders = Forwarders([forwarder])
    assert list(forwarders.changes({})) == []
    clock.advance(61.0)
    (report,) = forwarders.changes({})
    assert (report.part, "away for 61 s" in report.text) == ("forwarder-county", True)
    assert list(forwarders.changes({"forwarder-county": report.text})) == [], "it is reported"
    forwarder._status.set("connected")
    (well,) = forwarders.changes({"forwarder-county": report.text})
    assert well.text == ""
    (gone,) = Forwarders([]).changes({"forwarder-other": "x", "log": "y"})
    assert (gone.part, gone.text) == ("forwarder-other", "")


def test_standby_sends_nothing(closing: ExitStack) -> None:
    server, leads = serve(closing), Event()
    forwarder = forwarder_to(server.port, closing, leads.is_set)
    forwarder.reset(Scene().picture())
    forwarder.start()
    until(lambda: forwarder.view().state == "standby", "it stands by")
    assert forwarder.problem() == ""
    leads.set()
    until(lambda: server.received and uids(server.received[0]), "it leads and sends")
    leads.clear()
    until(lambda: forwarder.view().state == "standby", "it has left")
    assert len(server.received) == 1


def test_each_table_of_the_settings_has_a_kind() -> None:
    around = surroundings(SystemClock())
    tables: dict[str, dict[str, TakConfig]] = {kind.table: {} for kind in FORWARDERS}
    assert make_forwarders(tables, around).views() == ()
    county = {"county": TakConfig("tcp://127.0.0.1:9")}
    made = make_forwarders({**tables, "tak": county}, around)
    (view,) = made.views()
    assert (view.name, view.kind, view.state) == ("county", "tak", "connecting")
