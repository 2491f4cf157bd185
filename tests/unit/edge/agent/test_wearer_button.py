"""A mayday by the wearer's button: sent whatever fails, and active until it is cancelled."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event, Thread

import pytest

from edge.agent import runtime
from edge.agent.runtime import Agent
from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.samples import SensorBatch
from edge.sources.tabletop import TabletopSource
from edge.storage.data_folder import UnitDataFolder
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import COMMAND, EVENT, REPLY, STATUS
from shared.codec import decode, encode
from shared.errors import RecordingError
from shared.messages import (
    Command,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
    Header,
    Status,
    UnitEvent,
)
from tests.rig.scripted_button import ScriptedButton
from tests.rig.waiting import PATIENCE_S, until

MAYDAY, CANCELLED = EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED


class Station:
    """The other end, which notes what the unit says."""

    def __init__(self) -> None:
        self.router = MemoryRouter()
        self.bus = self.router.attach_station()
        self.events: list[UnitEvent] = []
        self.statuses: list[Status] = []
        self.replies: list[CommandReply] = []
        for channel, kept in (
            (EVENT, self.events),
            (STATUS, self.statuses),
            (REPLY, self.replies),
        ):
            self.bus.subscribe(
                channel.key("*"),
                lambda _, payload, channel=channel, kept=kept: kept.append(  # type: ignore[misc]
                    decode(channel, payload)
                ),
            )

    def open_bus(self) -> Bus:
        return self.router.attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return ""

    def calls(self) -> list[EventKind]:
        return [one.kind for one in self.events if one.kind in (MAYDAY, CANCELLED)]


class Unit:
    """One run of its agent."""

    def __init__(self, folder: Path, source: TabletopSource | None = None) -> None:
        self.station = Station()
        self.button = ScriptedButton()
        self.stop = Event()
        self.error: BaseException | None = None
        self._data = UnitDataFolder(folder / "u1")
        config = EdgeConfig("bench:1", unit="u1", tracker="none", data=folder)
        self.agent: Agent = compose_agent(
            *(config, "u1", self._data, source or TabletopSource("1"), self.station, 1.0),
            auxiliaries=(self.button.reader,),
        )
        self._thread = Thread(target=self._run)

    def _run(self) -> None:
        try:
            self.agent.run(self.stop)
        except (RecordingError, ZeroDivisionError) as error:
            self.error = error

    def start(self) -> None:
        self._thread.start()
        until(lambda: self.station.events, "the unit has started")

    def end(self) -> None:
        self.stop.set()
        self.join()

    def join(self) -> None:
        self._thread.join(PATIENCE_S)
        assert not self._thread.is_alive()
        self._data.close()


@contextmanager
def running(folder: Path) -> Iterator[Unit]:
    unit = Unit(folder)
    unit.start()
    try:
        yield unit
    finally:
        unit.end()


def test_a_mayday_is_sent_and_stands_in_the_status_until_it_is_cancelled(tmp_path: Path) -> None:
    with running(tmp_path) as unit:
        unit.button.press(3.5)
        until(lambda: unit.station.calls() == [MAYDAY], "the mayday")
        until(lambda: unit.station.statuses and unit.station.statuses[-1].mayday, "the status")
        unit.button.release(1.0)
        for _ in range(2):
            unit.button.press(0.2)
            unit.button.release(0.2)
        until(lambda: unit.station.calls() == [MAYDAY, CANCELLED], "it is cancelled")
        until(lambda: not unit.station.statuses[-1].mayday, "the status")


@pytest.mark.parametrize("is_cancelled", [False, True])
def test_after_a_restart_a_mayday_is_active_until_it_is_cancelled(tmp_path, is_cancelled) -> None:
    """In order, too: whoever restarts the agent has not helped its wearer."""
    with running(tmp_path) as unit:
        unit.button.press(3.5)
        until(lambda: unit.station.calls() == [MAYDAY], "the mayday")
    for _ in range(2):
        with running(tmp_path) as unit:
            until(lambda unit=unit: unit.station.calls() == [MAYDAY], "it is said again")  # type: ignore[misc]
            until(lambda unit=unit: unit.station.statuses, "a status")  # type: ignore[misc]
            assert unit.station.statuses[-1].mayday
            if is_cancelled:
                for _ in range(2):
                    unit.button.press(0.2)
                    unit.button.release(0.2)
                until(lambda unit=unit: unit.station.calls() == [MAYDAY, CANCELLED], "cancelled")  # type: ignore[misc]
                break
    with running(tmp_path) as unit:
        until(lambda: unit.station.statuses, "a status")
        assert unit.station.statuses[-1].mayday is not is_cancelled
        assert unit.station.calls() == ([] if is_cancelled else [MAYDAY])


@pytest.mark.parametrize("presses", [1, 2])
def test_a_short_press_acknowledges_and_so_does_a_hasty_thumb(tmp_path: Path, presses: int) -> None:
    with running(tmp_path) as unit:
        command = Command(Header("station", 1, 1, 0), "c1", CommandKind.EVACUATE, "anna", 0)
        unit.station.bus.publish(COMMAND.key("u1"), encode(command), COMMAND.qos)
        until(lambda: unit.station.replies, "it has arrived")
        for _ in range(presses):
            unit.button.press(0.2)
            unit.button.release(0.2)
        unit.button.advance(1.0)
        until(lambda: len(unit.station.replies) == 2, "the answer")
        assert unit.station.replies[-1].state is CommandState.ACKNOWLEDGED
        assert unit.station.calls() == []


def test_two_presses_that_cancel_a_mayday_acknowledge_nothing(tmp_path: Path) -> None:
    with running(tmp_path) as unit:
        command = Command(Header("station", 1, 1, 0), "c1", CommandKind.EVACUATE, "anna", 0)
        unit.station.bus.publish(COMMAND.key("u1"), encode(command), COMMAND.qos)
        unit.button.press(3.5)
        unit.button.release(1.0)
        for _ in range(2):
            unit.button.press(0.2)
            unit.button.release(0.2)
        until(lambda: unit.station.calls() == [MAYDAY, CANCELLED], "it is cancelled")
    assert [one.state for one in unit.station.replies] == [CommandState.RECEIVED]


def test_a_mayday_is_sent_where_the_tracker_fails_at_that_moment(tmp_path, monkeypatch) -> None:
    unit = Unit(tmp_path)

    def fail(*_: object) -> None:
        del unit.button.reader.take  # what is taken from now on comes after the failure
        raise ZeroDivisionError("of the tracker")

    monkeypatch.setattr(runtime, "_EARLY_NS", 0)
    unit.start()
    unit.button.reader.take = lambda: ()  # type: ignore[method-assign]
    unit.button.press(3.5)
    unit.agent._parts.pipeline.step = fail  # type: ignore[method-assign,assignment]
    unit.join()
    assert isinstance(unit.error, ZeroDivisionError)
    assert unit.station.calls() == [MAYDAY]


def fail_at_once(unit: Unit) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("of the tracker")

    unit.agent._parts.pipeline.step = fail  # type: ignore[method-assign,assignment]


def test_a_tracker_that_fails_at_each_start_leaves_time_to_call(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(runtime, "_CALLS_NS", 10**18)
    unit = Unit(tmp_path)
    fail_at_once(unit)
    unit.start()
    until(lambda: any("ZeroDivisionError" in one.detail for one in unit.station.events), "a fault")
    unit.button.press(3.5)
    until(lambda: unit.station.calls() == [MAYDAY], "the mayday")
    monkeypatch.setattr(runtime, "_CALLS_NS", 0)
    unit.join()
    assert isinstance(unit.error, ZeroDivisionError)
    faults = [one for one in unit.station.events if one.kind is EventKind.SENSOR_FAULT]
    assert len(faults) == 1


def test_a_hold_that_is_found_by_an_agent_that_fails_at_once_is_a_mayday(tmp_path, monkeypatch):
    """Its service starts it again and again, and its wearer holds the button all the while."""
    monkeypatch.setattr(runtime, "_EARLY_NS", -1)
    unit = Unit(tmp_path)
    fail_at_once(unit)
    unit.button.is_pressed = True
    unit.start()
    unit.button.let_look()
    unit.button.clock.advance(3.5)
    unit.join()
    assert isinstance(unit.error, ZeroDivisionError)
    assert unit.station.calls() == [MAYDAY]


def test_a_mayday_that_is_being_called_as_the_source_fails_is_sent(tmp_path: Path) -> None:
    fails = Event()

    class Failing(TabletopSource):
        def batches(self) -> Iterator[SensorBatch]:
            for batch in super().batches():
                if fails.is_set():
                    raise RecordingError("the cable is broken")
                yield batch

    unit = Unit(tmp_path, Failing("1"))
    unit.start()
    unit.button.press(1.9)
    fails.set()
    until(lambda: unit.button.reader._is_deciding and unit.agent._parts.reader.ended, "the end")
    unit.button.clock.advance(0.2)
    unit.join()
    assert isinstance(unit.error, RecordingError)
    assert unit.station.calls() == [MAYDAY]


def test_fault_of_the_button_is_an_event_of_the_unit(tmp_path: Path) -> None:
    with running(tmp_path) as unit:
        unit.button.is_there = False
        until(
            lambda: any("there is no button" in one.detail for one in unit.station.events),
            "the fault",
        )
    (fault,) = (one for one in unit.station.events if "there is no button" in one.detail)
    assert fault.kind is EventKind.SENSOR_FAULT
