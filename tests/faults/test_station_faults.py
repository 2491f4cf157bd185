"""A station whose own parts fail reports it, and tracking continues."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Event

import pytest

from base_station.core.alarms import ALARMS
from base_station.core.alarms.interface import Verdict
from base_station.core.events import Output, Received, StationEvent
from base_station.core.pipeline import StationPipeline
from base_station.core.state import UnitState
from base_station.engine import engine as drive_module
from base_station.engine.checkpoint_writer import CheckpointWriter
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.engine import StationEngine
from base_station.fusion import FUSERS
from base_station.storage.recorder import Recorder
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import LogRecord
from shared.messages import Message, Position
from shared.messages.station import ForgetWearers, RegisterUnit
from tests.rig.live_station import LiveStation, Screen, make_pipeline, ports_of
from tests.rig.station_script import Script
from tests.rig.waiting import PATIENCE_S, until

MakePosition = Callable[..., Position]
U = "FF-01"


def follows(station: LiveStation, make_position: MakePosition, north_m: float) -> None:
    """A position still reaches the console."""
    station.publish(make_position(north_m=north_m))

    def shown() -> bool:
        position = station.snapshot().units[0].position
        return position is not None and abs(position.north_m - north_m) < 0.01

    until(shown)


def test_a_log_that_cannot_be_written_is_an_alarm(
    tmp_path: Path, make_position: MakePosition, monkeypatch: pytest.MonkeyPatch
) -> None:
    trouble = {"now": ""}
    monkeypatch.setattr(Recorder, "problem", property(lambda _: trouble["now"]))
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        trouble["now"] = "the log cannot be written: the disk is full"
        until(lambda: "log" in station.pipeline.state.problems)
        follows(station, make_position, 4.0)
        shown = station.snapshot()
        assert [alarm.text for alarm in shown.alarms] == [trouble["now"]]
        assert trouble["now"] in shown.health.problems
        trouble["now"] = ""
        until(lambda: not station.pipeline.state.problems)
        assert [alarm.state for alarm in station.snapshot().alarms] == ["resolved"]


def test_a_checkpoint_that_cannot_be_saved_is_reported(
    tmp_path: Path, make_position: MakePosition, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drive_module, "CHECKPOINT_NS", 10**8)
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        shutil.rmtree(tmp_path / "checkpoints")
        (tmp_path / "checkpoints").write_text("in the way")
        until(lambda: "checkpoint" in station.pipeline.state.problems)
        follows(station, make_position, 4.0)


def test_error_in_the_pipeline_loses_one_message(
    tmp_path: Path, make_position: MakePosition, monkeypatch: pytest.MonkeyPatch
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        step = station.pipeline.step
        failures = iter([True])

        def sometimes(event: StationEvent) -> list[Output]:
            is_position = isinstance(event, Received) and isinstance(event.message, Position)
            if is_position and next(failures, False):
                raise ArithmeticError("a mistake")
            return step(event)

        monkeypatch.setattr(station.pipeline, "step", sometimes)
        station.publish(make_position(north_m=1.0))
        until(lambda: "pipeline" in station.pipeline.state.problems)
        follows(station, make_position, 4.0)


def wait_for_ticks(station: LiveStation) -> None:
    count = len(station.screen.deltas)
    until(lambda: len([one for one in station.screen.deltas[count:] if one.health]) > 2)


@pytest.mark.parametrize("refuses", [False, True])
def test_unsaved_messages_are_not_acknowledged(
    tmp_path: Path, make_position: MakePosition, monkeypatch: pytest.MonkeyPatch, refuses: bool
) -> None:
    """Its unit would forget it; what there is room for in memory only is asked for alerts."""
    behind = {"now": True}
    monkeypatch.setattr(Recorder, "is_behind", property(lambda _: behind["now"]))
    monkeypatch.setattr(Recorder, "refuses", property(lambda _: behind["now"] and refuses))
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.publish(make_position())
        wait_for_ticks(station)
        assert not station.reported
        assert (U in station.reported_unsafe) != refuses
        behind["now"] = False
        until(lambda: U in station.reported)


def test_erasure_waits_for_the_checkpoint_in_progress(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has them in it, and would be read at the next start."""
    saving = {"now": True}
    monkeypatch.setattr(CheckpointWriter, "is_under_way", property(lambda _: saving["now"]))
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        forgotten = station.drive.submit("chief", ForgetWearers(U))
        wait_for_ticks(station)
        assert not forgotten.done()
        saving["now"] = False
        assert forgotten.result(PATIENCE_S).refused is None


class DiscardingLog:
    """A ``Log`` that keeps nothing."""

    problem = low_disk_space = ""
    is_behind = refuses = False

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        del t_ns, key, payload
        return True

    def flush(self) -> bool:
        return True


class IdleFeed:
    """A ``Feed`` that brings nothing; waiting takes no time."""

    follows = False

    def __init__(self, clock: ManualClock, takes: int) -> None:
        self._clock = clock
        self._left = takes
        self.done = Event()

    def take(self, timeout_s: float) -> list[LogRecord]:
        self._left -= 1
        if self._left <= 0:
            self.done.set()
        self._clock.advance(max(timeout_s, 1e-4))
        return []

    def wake(self) -> None:
        pass


def test_failing_snapshot_is_retried_without_load_and_logged_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is tried again at every turn, for days perhaps."""
    clock = ManualClock()
    feed = IdleFeed(clock, 300)
    ports = ports_of(feed, DiscardingLog(), Screen(), tmp_path, clock)
    drive = StationEngine(make_pipeline(), ports)

    def fail(*_: object) -> None:
        raise KeyError("a mistake")

    monkeypatch.setattr(ConsolePublisher, "publish_delta", fail)
    drive.start()
    feed.done.wait(PATIENCE_S)
    drive.stop()
    assert clock.monotonic_ns() > 10 * NS_PER_S
    assert len([one for one in caplog.records if one.exc_info]) == 1


@dataclass(frozen=True)
class FailsFor:
    """A rule that cannot cope with one unit."""

    unit_id: str
    name: str = "fails"
    levels: tuple[str, ...] = ("x",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        if unit.unit_id == self.unit_id:
            raise KeyError(level)
        return None


def test_repeatedly_failing_rule_raises_one_alarm() -> None:
    script = Script(StationPipeline((FailsFor(U), *ALARMS), FUSERS[0]))
    script.register(U, "FF-02")
    script.wait(60, lambda: [script.status(U), script.status("FF-02")])
    assert [alarm.rule for alarm in script.alarms] == ["station"]
