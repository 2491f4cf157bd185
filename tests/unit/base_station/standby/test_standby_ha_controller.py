"""Take-over by a standby, whatever its own disk has accepted of the log."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from threading import Event, Thread

import pytest

from base_station.config import StandbyConfig
from base_station.core.log_position import LogPosition
from base_station.engine.feed import LiveFeed
from base_station.engine.log_feed import FolderFeed
from base_station.engine.station_clock import SteadyClock
from base_station.standby.ha_controller import HaController, HaDependencies
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from shared.bus_memory import MemoryRouter
from shared.channels import OPERATOR
from shared.clock import SystemClock
from shared.codec import decode
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import TakeOver
from tests.rig.standby_logs import FullDisk, events
from tests.rig.waiting import until


class LogFollower:
    """A standby that has followed the other; its engine steps the delivered records."""

    def __init__(self, folder: Path) -> None:
        clock = SteadyClock(SystemClock())
        self.disk = FullDisk()
        self.log = SharedLog(self.disk, clock)
        self.feed = StandbyFeed(LiveFeed(clock), clock)
        around = HaDependencies(
            MemoryRouter().attach_station(), self.log, FolderFeed(folder), self.feed, clock,
            on_lead=lambda: None, start_again=lambda _: None,
        )  # fmt: skip
        self.pair = HaController(StandbyConfig("b", ("tcp/127.0.0.1:1",)), around)
        self.log.follows = True
        self._ending = Event()
        self._drive = Thread(target=self._step, daemon=True)
        self._drive.start()

    def _step(self) -> None:
        while not self._ending.is_set():
            for record in self.feed.take(0.01):
                self.log.write(*record)

    def deliver(self, count: int) -> None:
        for t_ns, key, payload in events(count):
            self.feed.deliver([(t_ns, key, payload)])
            delivered = self.pair._follower.delivered.next(t_ns)
            self.pair._follower.delivered = delivered
        until(lambda: self.feed.waiting == 0)

    def close(self) -> None:
        self._ending.set()
        self._drive.join()
        self.feed.close()
        self.pair.start()  # or there is nothing to be closed
        self.pair.close()


@pytest.fixture
def follower(tmp_path: Path) -> Iterator[LogFollower]:
    follower = LogFollower(tmp_path)
    yield follower
    follower.close()


@pytest.mark.parametrize("room", [9, 3])
def test_standby_takes_over_at_once_though_its_disk_refused_records(
    follower: LogFollower, monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    """The place up to which it has stepped is not in its log, and never will be."""
    monkeypatch.setattr("base_station.standby.ha_controller._STEP_S", 60.0)
    follower.disk.room = room
    follower.deliver(9)
    place = follower.log.place
    assert follower.log.is_cut_short == (room < 9)
    follower.disk.room = 100
    leading = Thread(target=follower.pair._decide, kwargs={"by_hand": True}, daemon=True)
    leading.start()
    leading.join(30.0)
    assert follower.pair.leads
    t_ns, key, payload = follower.disk.kept[-1]
    message = decode(OPERATOR, payload)
    assert isinstance(message, OperatorAction)
    assert (key, message.action) == (
        OPERATOR.key(STATION_ID),
        TakeOver(1, "b", place.t_ns, place.events),
    )
    assert follower.log.place == LogPosition(t_ns, 1)


def test_refused_records_are_not_taken_for_a_log_that_is_still_fetched(
    follower: LogFollower,
) -> None:
    """Waiting would change nothing: it has stepped all of it."""
    follower.disk.room = 3
    follower.deliver(9)
    me = follower.pair._me()
    assert me.place < me.stepped == follower.pair._follower.delivered
