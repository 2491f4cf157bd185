"""Decisions of the station are on the disk before they are published, where that matters."""

from __future__ import annotations

from typing import cast

import pytest

from base_station.core.events import Output, StationEvent
from base_station.core.pipeline import StationPipeline
from base_station.core.state import StationState
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.health_monitor import HealthMonitor
from base_station.engine.projector import Projector
from base_station.engine.write_ahead import WriteAhead
from shared.channels import ALARM as ALARM_CHANNEL
from shared.channels import TICK
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, AlarmState, Header, Tick

T_NS = 1_700_000_000_000_000_000
HEADER = Header(STATION_ID, 1, 1, T_NS, t_utc_ns=T_NS)
ALARM = AlarmChange(
    header=HEADER,
    alarm_id="a1",
    rule="link-lost",
    unit_id="FF-01",
    priority=2,
    state=AlarmState.RAISED,
    level="",
    text="no word from Anna",
    by="",
    raised_ns=T_NS,
    last_raised_ns=T_NS,
)


class FixedPipeline:
    """A pipeline with the same decisions for any input."""

    def __init__(self, outputs: list[Output]) -> None:
        self.state = StationState()
        self._outputs = outputs

    def step(self, _: StationEvent) -> list[Output]:
        return self._outputs


class Publisher:
    """A ``ConsolePublisher`` without consoles."""

    def mark_changed(self, outputs: list[Output]) -> None:
        pass


class Disk:
    """A ``Log`` that counts the waits for the disk."""

    problem = low_disk_space = ""
    is_behind = refuses = False

    def __init__(self) -> None:
        self.flushed = 0
        self.keys: list[str] = []

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        del t_ns, payload
        self.keys.append(key)
        return True

    def flush(self) -> bool:
        self.flushed += 1
        return True


def over(disk: Disk, outputs: list[Output]) -> WriteAhead:
    pipeline, publisher = (
        cast("StationPipeline", FixedPipeline(outputs)),
        cast("ConsolePublisher", Publisher()),
    )
    return WriteAhead(pipeline, disk, (publisher,), Projector(), HealthMonitor())


@pytest.mark.parametrize(
    ("urgent", "outputs", "flushed"), [(False, [], 0), (False, [ALARM], 1), (True, [], 1)]
)
def test_urgent_records_and_alarms_are_on_disk_before_they_are_published(
    urgent: bool, outputs: list[Output], flushed: int
) -> None:
    """The alarm of a long silence follows from a tick, which itself can wait."""
    disk = Disk()
    ahead = over(disk, outputs)
    ahead.append_and_apply(T_NS, TICK.key(STATION_ID), encode(Tick(HEADER, T_NS)), urgent=urgent)
    for _ in range(2):  # one wait for the disk
        ahead.flush_urgent()
        assert disk.flushed == flushed


@pytest.mark.parametrize(
    ("log", "written"),
    [
        ("event decision event", 1),  # a crash came between the two
        ("event decision event decision", 0),
        ("event event decision event decision", 0),  # the first was refused: too late for it
    ],
)
def test_records_lost_by_a_crash_are_written_at_the_start(log: str, written: int) -> None:
    disk = Disk()
    records = {
        "event": (TICK.key(STATION_ID), encode(Tick(HEADER, T_NS))),
        "decision": (ALARM_CHANNEL.key(STATION_ID), encode(ALARM)),
    }
    reported = [(T_NS + number, *records[one]) for number, one in enumerate(log.split())]
    assert over(disk, [ALARM]).rebuild(reported, (0, 0)) == log.split().count("event")
    assert disk.keys.count(ALARM_CHANNEL.key(STATION_ID)) == written
