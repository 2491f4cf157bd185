"""Checkpoints of the live state are written beside the engine, and never exceed the log."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest

from base_station.engine.checkpoint_writer import PART, CheckpointWriter
from base_station.engine.health_monitor import HealthMonitor
from base_station.storage.checkpoints import Checkpoints
from shared.messages.station import ForgetWearers, RegisterUnit
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.waiting import PATIENCE_S, until

STATE = make_pipeline().checkpoint()


class Log:
    """A log whose disk writes as much as the test allows."""

    problem = low_disk_space = ""
    is_behind = refuses = False

    def __init__(self) -> None:
        self.takes = True
        self.may_flush = Event()
        self.may_flush.set()

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        raise NotImplementedError

    def flush(self) -> bool:
        self.may_flush.wait()
        return self.takes


def reported(health: HealthMonitor) -> list[tuple[str, str]]:
    return [(report.part, report.text) for report in health.check({}, {})]


def test_record_that_a_crash_would_lose_is_not_saved(tmp_path: Path) -> None:
    log, checkpoints, health = Log(), Checkpoints(tmp_path), HealthMonitor()
    writer = CheckpointWriter(log, checkpoints, health)
    for takes, t_ns in ((True, 100), (False, 200)):
        log.takes = takes
        writer.begin((t_ns, 3), STATE)
        writer.finish()
    saved = checkpoints.latest()
    assert saved is not None
    assert (saved.t_ns, saved.events_at_t) == (100, 3)
    assert reported(health) == []


@pytest.mark.parametrize(
    ("error", "reason"),
    [(OSError(28, "No space left on device"), "free the disk"), (KeyError("x"), "please report")],
)
def test_failed_checkpoint_is_reported_until_one_is_saved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, reason: str
) -> None:
    log, checkpoints, health = Log(), Checkpoints(tmp_path), HealthMonitor()

    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(checkpoints, "save", fail)
    writer = CheckpointWriter(log, checkpoints, health)
    log.may_flush.clear()
    writer.begin((100, 1), STATE)
    writer.check()
    assert (writer.is_under_way, reported(health)) == (True, [])
    log.may_flush.set()
    until(lambda: not writer.is_under_way)
    writer.check()
    ((part, text),) = reported(health)
    assert part == PART
    assert reason in text
    writer.check()
    assert reported(health) == []


def test_checkpoints_are_saved_one_after_the_other(tmp_path: Path) -> None:
    log, checkpoints = Log(), Checkpoints(tmp_path)
    writer = CheckpointWriter(log, checkpoints, HealthMonitor())
    writer.begin((100, 1), STATE)
    writer.begin((200, 1), STATE)
    assert checkpoints.latest(until_ns=199) is not None, "the first is there by then"
    writer.finish()
    saved = checkpoints.latest()
    assert saved is not None
    assert saved.t_ns == 200


def test_operators_do_not_wait_for_a_disk_that_refuses_checkpoints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Except for an erasure: the checkpoint in progress holds the person."""
    begun, answers = Event(), Event()

    def hang(*_: object) -> None:
        begun.set()
        answers.wait()

    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", "one"))
        monkeypatch.setattr(station.checkpoints, "save", hang)
        station.drive.save_soon()
        assert begun.wait(PATIENCE_S)
        forgotten = station.drive.submit("chief", ForgetWearers("FF-01"))
        station.act(RegisterUnit("FF-02", "two"))
        assert not forgotten.done()
        answers.set()
        assert forgotten.result(PATIENCE_S).refused is None
