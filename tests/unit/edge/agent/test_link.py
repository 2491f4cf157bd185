"""The link comes and goes; the unit is declared on it each time, and does not wait for it."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator
from contextlib import nullcontext

import pytest

from edge.agent.link import Link
from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.samples import SensorBatch
from edge.sources.registry import open_source
from edge.sources.tabletop import TabletopSource
from edge.storage.data_folder import UnitDataFolder
from edge.storage.journal.journal import Journal
from shared.bus_memory import MemoryRouter
from shared.channels import COMMAND, EVENT, EVERY_UNIT, HEARTBEAT, POSITION, Qos, alive_key
from shared.codec import decode
from shared.errors import BusError, RecordingError, StoreError
from shared.messages import EventKind, UnitEvent
from shared.messages.event import FAILED
from tests.rig.waiting import PATIENCE_S, until


class Station:
    """Another end of the bus that records what it receives."""

    def __init__(self) -> None:
        self.router = MemoryRouter()
        self.bus = self.router.attach_station()
        self.alive: list[bool] = []
        self.positions: list[bytes] = []
        self.bus.subscribe(HEARTBEAT.key("*"), lambda _, payload: None)
        self.bus.watch_alive(alive_key("*"), lambda _, alive: self.alive.append(alive))
        self.bus.subscribe(POSITION.key("*"), lambda _, payload: self.positions.append(payload))


@pytest.fixture
def station() -> Station:
    return Station()


class FakeStation:
    def __init__(self, open_bus) -> None:
        self.open_bus = open_bus
        self.reachable = threading.Event()
        self.reachable.set()
        self.probed = 0

    def is_reachable(self, timeout_s: float) -> bool:
        self.probed += 1
        return self.reachable.wait(timeout_s)

    def link_failure_reason(self) -> str:
        return "nobody is there"


def make_link(open_bus, commands, other_end: FakeStation | None = None) -> Link:
    return Link(
        "u1",
        other_end or FakeStation(open_bus),
        lambda _, payload: commands.append(payload),
        [("muster/v1/u1/journal/**", lambda key, parameters, payload: [b"journal"])],
    )


def test_linked_unit_has_a_token_receives_commands_and_serves_its_journal(station):
    commands: list[bytes] = []
    link = make_link(station.router.attach_unit, commands)
    until(lambda: station.alive == [True])
    station.bus.publish(COMMAND.key("u1"), b"own", Qos.ALERT)
    station.bus.publish(COMMAND.key(EVERY_UNIT), b"all", Qos.ALERT)
    station.bus.publish(COMMAND.key("u2"), b"another's", Qos.ALERT)
    assert commands == [b"own", b"all"]
    assert list(station.bus.query("muster/v1/u1/journal/index", b"", 1.0)) == [b"journal"]
    link.close()
    assert station.alive == [True, False]


def test_outage_cuts_the_link_and_its_end_restores_it(station):
    link = make_link(station.router.attach_unit, [])
    until(lambda: station.alive == [True])
    link.publish(POSITION.key("u1"), b"1", Qos.LIVE)
    link.set_up(up=False)
    until(lambda: station.alive == [True, False])
    link.publish(POSITION.key("u1"), b"2", Qos.LIVE)
    link.set_up(up=True)
    until(lambda: station.alive == [True, False, True])
    link.publish(POSITION.key("u1"), b"3", Qos.LIVE)
    assert station.positions == [b"1", b"3"]
    link.close()


def test_bus_that_cannot_be_opened_is_reported_once_and_retried(station, caplog, monkeypatch):
    monkeypatch.setattr("edge.agent.link._RETRY_S", 0.01)
    tries: list[int] = []

    def open_bus():
        tries.append(1)
        if len(tries) < 4:
            raise BusError("the bus cannot be opened")
        return station.router.attach_unit()

    with caplog.at_level(logging.WARNING):
        link = make_link(open_bus, [])
        link.publish(POSITION.key("u1"), b"lost", Qos.LIVE)  # no bus: no error
        until(lambda: station.alive == [True])
        link.close()
    assert [record.message for record in caplog.records] == [
        "the bus cannot be opened; trying again every second"
    ]


def test_reason_of_an_unopened_bus_is_reported_once(caplog, monkeypatch):
    """A unit of two stations opens none before one of them is there."""
    monkeypatch.setattr("edge.agent.link._RETRY_S", 0.01)
    tries: list[int] = []

    def open_bus():
        tries.append(1)
        raise BusError("the bus cannot be opened")

    with caplog.at_level(logging.WARNING):
        link = make_link(open_bus, [])
        until(lambda: "no link: nobody is there; messages are kept" in caplog.text)
        more = len(tries) + 5
        until(lambda: len(tries) > more)
        link.close()
    assert caplog.text.count("no link") == 1


def test_missing_link_is_reported_once_and_its_return_too(station, caplog, monkeypatch):
    monkeypatch.setattr("edge.agent.link._CHECK_S", 0.01)
    bus = station.router.attach_unit()
    bus.link_down()
    with caplog.at_level(logging.INFO):
        link = make_link(lambda: bus, [])
        until(lambda: "no link: nobody is there" in caplog.text)
        bus.link_up()
        until(lambda: "linked to the station" in caplog.text)
        link.close()
    assert caplog.text.count("no link") == 1


def test_link_that_returns_before_its_reason_is_known_is_not_reported_lost(
    station, caplog, monkeypatch
):
    monkeypatch.setattr("edge.agent.link._CHECK_S", 0.01)
    bus = station.router.attach_unit()
    bus.link_down()
    asked, answers = threading.Event(), threading.Event()

    class Slow(FakeStation):
        def link_failure_reason(self) -> str:
            asked.set()
            answers.wait(PATIENCE_S)
            return "nobody is there"

    before = set(threading.enumerate())
    with caplog.at_level(logging.INFO):
        link = make_link(lambda: bus, [], Slow(lambda: bus))
        assert asked.wait(PATIENCE_S)
        bus.link_up()
        until(lambda: "linked to the station" in caplog.text)
        answers.set()
        link.close()
        until(lambda: set(threading.enumerate()) <= before)
    assert "no link" not in caplog.text


def test_link_that_stays_away_is_opened_again(station, caplog, monkeypatch):
    monkeypatch.setattr("edge.agent.link._CHECK_S", 0.005)
    monkeypatch.setattr("edge.agent.link._REOPEN_AFTER_S", 0.05)
    opened = []

    def open_bus():
        bus = station.router.attach_unit()
        opened.append(bus)
        if len(opened) < 4:
            bus.link_down()  # and never comes back
        return bus

    with caplog.at_level(logging.INFO):
        link = make_link(open_bus, [])
        until(lambda: station.alive == [True])
        until(lambda: "linked to the station" in caplog.text)
        link.close()
    assert len(opened) == 4
    assert caplog.text.count("no link") == 1


def test_repeated_requests_for_a_link_check_it_no_sooner(station, monkeypatch):
    """The agent requests it with every batch; hurried checks gave up a slow link too early."""
    monkeypatch.setattr("edge.agent.link._CHECK_S", PATIENCE_S)
    monkeypatch.setattr("edge.agent.link._REOPEN_AFTER_S", 1000 * PATIENCE_S)
    checks: list[int] = []
    bus = station.router.attach_unit()

    def is_linked() -> bool:
        checks.append(1)
        return False

    bus.is_linked = is_linked
    link = make_link(lambda: bus, [])
    until(lambda: checks)
    for _ in range(100):
        link.set_up(up=True)
        time.sleep(0.001)  # a woken worker would check now
    link.set_up(up=False)
    link.close()
    assert len(checks) == 1


def test_lost_link_is_probed_and_opened_again_at_once(station, monkeypatch):
    """A link that never was is given longer: connecting takes a moment."""
    monkeypatch.setattr("edge.agent.link._CHECK_S", 0.005)
    monkeypatch.setattr("edge.agent.link._REOPEN_AFTER_S", 1e6)
    opened = []

    def open_bus():
        opened.append(station.router.attach_unit())
        return opened[-1]

    other_end = FakeStation(open_bus)
    link = make_link(open_bus, [], other_end)
    until(lambda: station.alive == [True])
    other_end.reachable.clear()
    opened[0].link_down()
    until(lambda: other_end.probed > 3)
    assert len(opened) == 1, "no bus is opened towards nobody"
    other_end.reachable.set()
    until(lambda: station.alive == [True, False, True])
    link.close()


def test_agent_with_a_stopped_link_ends_to_be_restarted(station, tmp_path):
    """It would continue, look healthy to its supervisor, and never be received again."""
    data = UnitDataFolder(tmp_path / "u1")
    config = EdgeConfig("simulated:straight", unit="u1", tracker="none", data=tmp_path)
    source = open_source(config.source)
    other_end = FakeStation(station.router.attach_unit)
    agent = compose_agent(config, "u1", data, source, other_end, speed=1.0)
    agent._parts.link.close()
    with pytest.raises(RuntimeError, match="the link has stopped"):
        agent.run(threading.Event(), for_s=60.0)
    assert how_it_stopped(data) == FAILED
    data.close()


def test_unusable_bus_ends_no_agent(station, tmp_path, caplog):
    """The link opens it again; the wearer's path does not begin anew for it."""
    asked: list[str] = []
    stop = threading.Event()

    def open_bus():
        bus = station.router.attach_unit()

        def ask(selector: str, *_: object, **__: object) -> None:
            asked.append(selector)
            if len(asked) > 1:
                stop.set()
            raise BusError("the bus is closed")

        bus.ask = ask
        return bus

    data = UnitDataFolder(tmp_path / "u1")
    config = EdgeConfig("bench:1", unit="u1", tracker="none", data=tmp_path)
    source = open_source(config.source)
    agent = compose_agent(config, "u1", data, source, FakeStation(open_bus), speed=1.0)
    agent.run(stop)
    assert how_it_stopped(data) == "stopped by a signal"
    assert caplog.text.count("cannot be asked") == 1
    data.close()


def test_failed_start_of_an_agent_leaves_nothing_running(station, tmp_path, monkeypatch):
    """An open link keeps the program from ending, and its service from starting it again."""

    def fail(_: object) -> None:
        raise StoreError("the journal cannot be read")

    monkeypatch.setattr("edge.app.composition.answers_before", fail)
    before = set(threading.enumerate())
    data = UnitDataFolder(tmp_path / "u1")
    config = EdgeConfig("bench:1", unit="u1", tracker="none", data=tmp_path)
    source = open_source(config.source)
    with pytest.raises(StoreError):
        compose_agent(
            config, "u1", data, source, FakeStation(station.router.attach_unit), speed=1.0
        )
    assert set(threading.enumerate()) <= before
    data.close()


@pytest.mark.parametrize(("fails", "reported"), [(True, FAILED), (False, "the source ended")])
def test_agent_with_a_failed_source_was_not_stopped(station, tmp_path, fails, reported):
    """Its state that must survive is restored when it is started again."""

    class Broken(TabletopSource):
        def batches(self) -> Iterator[SensorBatch]:
            if fails:
                raise RecordingError("the cable is broken")
            return iter(())

    data = UnitDataFolder(tmp_path / "u1")
    config = EdgeConfig("bench:1", unit="u1", tracker="none", data=tmp_path)
    other_end = FakeStation(station.router.attach_unit)
    agent = compose_agent(config, "u1", data, Broken("1"), other_end, speed=1.0)
    with pytest.raises(RecordingError) if fails else nullcontext():
        agent.run(threading.Event(), for_s=60.0)
    assert how_it_stopped(data) == reported
    data.close()


def how_it_stopped(data: UnitDataFolder) -> str:
    """The last stop message in its journal."""
    journal = Journal(data.journal, lambda: 1, 0, 10**9)
    event = decode(EVENT, next(journal.earlier_alerts(EVENT)).payload)
    journal.close()
    assert isinstance(event, UnitEvent)
    assert event.kind is EventKind.STOPPED
    return event.detail


def test_answer_that_hangs_with_the_disk_does_not_block_the_end_of_the_link(station, monkeypatch):
    monkeypatch.setattr("edge.agent.link._CLOSING_S", 0.2)
    asked, thawed = threading.Event(), threading.Event()

    def hangs(*_: object) -> Iterator[bytes]:
        asked.set()
        thawed.wait(PATIENCE_S)
        yield b""

    served = [("muster/v1/u1/journal/**", hangs)]
    link = Link("u1", FakeStation(station.router.attach_unit), lambda *_: None, served)
    until(lambda: station.alive == [True])
    question = "muster/v1/u1/journal/index"
    asking = threading.Thread(target=lambda: list(station.bus.query(question, b"", 1.0)))
    asking.start()
    asked.wait(PATIENCE_S)
    closing = threading.Thread(target=link.close)
    closing.start()
    closing.join(PATIENCE_S / 2)
    try:
        assert not closing.is_alive()
        assert station.alive == [True, False]
    finally:
        thawed.set()
        asking.join()
        closing.join()


def test_publishing_while_the_link_closes_is_no_error(station):
    failures: list[BaseException] = []
    stop = threading.Event()
    link = make_link(station.router.attach_unit, [])

    def publish() -> None:
        try:
            while not stop.is_set():
                link.publish(POSITION.key("u1"), b"x", Qos.LIVE)
        except BusError as error:
            failures.append(error)

    thread = threading.Thread(target=publish)
    thread.start()
    for _ in range(30):
        link.set_up(up=False)
        link.set_up(up=True)
    stop.set()
    thread.join()
    link.close()
    assert not failures
