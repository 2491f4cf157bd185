"""A unit whose clock is set by a day while it runs: nothing is lost, doubled or reordered."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import NamedTuple

import pytest

from shared.channels import is_backfilled, parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.mcap_log import read_log
from shared.messages import Heartbeat, Message, Position
from tests.rig.settable_clock import MachineClock
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.station_process import free_port
from tests.rig.unit_journal import MessageOfUnit, stated_by
from tests.rig.waiting import PATIENCE_S, until

UNIT = "anna"
DAY_S = 86_400.0
COMPILING_S = 200.0  # the first agent on a machine compiles its tracker
ALONE_S = 3.0  # each time


class Logged(NamedTuple):
    t_ns: int
    message: Message
    late: bool  # out of the journal

    @property
    def number(self) -> MessageOfUnit:
        return self.message.header.boot_id, self.message.header.seq


class UnitClockScene:
    """A station that is killed and started again, and a unit whose clock can be set."""

    def __init__(self, folder: Path, closing: ExitStack) -> None:
        self._folder, self._data, self._closing = folder, folder / "station", closing
        self._log = self._data / "log"
        self.clock = MachineClock(folder, "unit")
        bus = f"tcp/127.0.0.1:{free_port()}"
        self._serve = ["serve", "--data", str(self._data), "--listen", bus, "--insecure"]
        self._serve += ["--http", f"127.0.0.1:{free_port()}"]
        self.start_station()
        flags = ["--unit", UNIT, "--source", "simulated:search-ground-floor", "--connect", bus]
        with self.clock.ticks():
            agent = Agent(folder / "agent.txt", *flags, "--data", str(folder / "agent"))
        closing.callback(agent.kill)

    def start_station(self) -> None:
        reported = self._folder / f"station-{time.monotonic_ns()}.txt"
        self._station = self._closing.enter_context(Command(reported, *self._serve))
        address = self._station.wait_ready()
        with Browser(address, self._data) as browser:
            browser.call("POST", "/units", json={"unit_id": UNIT})

    def kill_station(self) -> None:
        self._station.kill()

    def output(self) -> set[MessageOfUnit]:
        return stated_by(self._folder / "agent" / UNIT / "journal.sqlite")

    def logged(self) -> list[Logged]:
        records = (
            (t_ns, *parse_key(key), key, reported) for t_ns, key, reported in read_log(self._log)
        )
        return [
            Logged(t_ns, decode(channel, reported), is_backfilled(key))
            for t_ns, unit_id, channel, key, reported in records
            if unit_id == UNIT
        ]

    def has(self, reported: set[MessageOfUnit]) -> bool:
        return reported <= {one.number for one in self.logged()}

    def is_received(self) -> bool:
        return sum(isinstance(one.message, Position) for one in self.logged()) > 30

    def is_stated_to_be_ahead(self, by_s: float) -> bool:
        """Live, by the unit."""
        beats = [one.message for one in self.logged() if not one.late]
        return any(isinstance(b, Heartbeat) and abs(b.clock_ahead_s - by_s) < 60 for b in beats)


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[UnitClockScene]:
    with ExitStack() as closing:
        yield UnitClockScene(tmp_path, closing)


def test_clock_set_by_a_day_keeps_order_and_times_with_and_without_a_station(
    ground: UnitClockScene,
) -> None:
    until(ground.is_received, "the unit is heard", COMPILING_S)
    for ahead_s in (DAY_S, -DAY_S):
        ground.clock.set_ahead(ahead_s)
        until(partial(ground.is_stated_to_be_ahead, ahead_s), "the clock is set")
        ground.kill_station()
        time.sleep(ALONE_S / 2)
        ground.clock.set_ahead(0.0)
        time.sleep(ALONE_S / 2)
        ground.clock.set_ahead(ahead_s)
        ground.start_station()
        reported = ground.output()
        until(partial(ground.has, reported), "the log has all")

    logged = ground.logged()
    assert len(logged) == len({one.number for one in logged})
    assert sum(one.late for one in logged) > 10
    for one in logged:
        stated_ago_s = (one.t_ns - one.message.header.t_utc_ns) / NS_PER_S
        assert -1.0 < stated_ago_s < PATIENCE_S
    headers = [one.message.header for one in logged]
    offsets_ns = [header.t_utc_ns - header.t_mono_ns for header in headers]
    assert max(offsets_ns) - min(offsets_ns) < NS_PER_S
