"""A station that was suspended for a while receives waiting messages before time advances."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from base_station.engine.engine import StationEngine
from base_station.engine.feed import LiveFeed
from base_station.storage.recorder import Recorder
from shared.channels import POSITION
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.messages import AlarmState, Header, Position
from shared.messages.station import Assign, OpenIncident, RegisterUnit
from tests.rig.live_station import Screen, make_pipeline, ports_of

MakePosition = Callable[..., Position]


class Station:
    """Its time, its turns and its two units are the test's."""

    def __init__(self, folder: Path, make_position: MakePosition) -> None:
        self.clock = ManualClock()
        self._feed, self._make, self._seq = LiveFeed(self.clock), make_position, 0
        self.recorder = Recorder(folder, self.clock)
        self.pipeline = make_pipeline()
        ports = ports_of(self._feed, self.recorder, Screen(), folder, self.clock)
        self._drive = StationEngine(self.pipeline, ports)
        self._drive.submit("chief", OpenIncident("i1", "Mill Lane"))
        for unit_id in ("FF-01", "FF-02"):
            self._drive.submit("chief", RegisterUnit(unit_id, unit_id))
            self._drive.submit("chief", Assign(unit_id, unit_id, unit_id, "red", "leader"))

    def turns(self, seconds: float, *speaking: str) -> None:
        for _ in range(round(2 * seconds)):
            for unit_id in speaking:
                self._seq += 1
                header = Header(unit_id, 7, self._seq, self.clock.monotonic_ns())
                self._feed.offer(POSITION.key(unit_id), encode(self._make(header=header)))
            self._drive._run_once()
            self.clock.advance(0.5)

    def lost(self) -> dict[str, AlarmState]:
        """States of the alarms of lost links, by unit."""
        alarms = self.pipeline.state.alarms.values()
        return {one.unit_id: one.state for one in alarms if one.rule == "link-lost"}


@pytest.fixture
def station(tmp_path: Path, make_position: MakePosition) -> Iterator[Station]:
    station = Station(tmp_path, make_position)
    yield station
    station.recorder.close()


def test_pause_of_the_station_marks_only_missing_units_lost(station: Station) -> None:
    station.turns(5.0, "FF-01", "FF-02")
    station.clock.advance(50.0)
    station.turns(1.0)  # links come back
    station.turns(8.0, "FF-01")
    assert station.lost() == {"FF-02": AlarmState.RAISED}


def test_time_advances_over_repeated_pauses(station: Station) -> None:
    station.turns(5.0, "FF-01")
    for _ in range(4):
        station.clock.advance(10.0)
        station.turns(0.5)
    assert station.lost() == {"FF-01": AlarmState.RAISED}
    assert station.pipeline.state.t_ns > station.clock.utc_ns() - 15 * NS_PER_S
