"""Unreadable messages of a unit's journal are in the log once, and are not fetched again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import msgspec
import pytest

from base_station.unit_sync.backfill import Backfill
from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import POSITION
from shared.clock import SystemClock
from shared.codec import encode
from shared.messages import Header, Position
from shared.messages.header import SCHEMA_REVISION
from shared.messages.station import RegisterUnit
from tests.rig.live_station import LiveStation
from tests.rig.waiting import until

MakePosition = Callable[..., Position]
U, BOOT = "FF-01", 0xB007


class Unit:
    """A journal of which some entries are of a newer program, of somebody else, or damaged."""

    def __init__(self, folder: Path, make_position: MakePosition) -> None:
        self._make = make_position
        messages = [
            self.position(2),
            self.position(3, schema=SCHEMA_REVISION + 1),
            self.position(4, unit_id="FF-02"),
            self.position(77),  # it is not the one that the journal calls it
            self.position(6),
        ]
        self.kept = [*map(encode, messages), b"\xff\xfe rotten", b""]
        self.journal = Journal(folder / "journal.sqlite", lambda: BOOT, 0, 10**9)
        entries = enumerate(self.kept, start=2)
        self.journal.append([JournalRow(seq, POSITION, seq, payload) for seq, payload in entries])

    def position(self, seq: int, **changes: object) -> Position:
        header = Header(U, BOOT, seq, seq * 10**8)
        return self._make(header=msgspec.structs.replace(header, **changes))


@pytest.fixture
def unit(tmp_path: Path, make_position: MakePosition) -> Iterator[Unit]:
    unit = Unit(tmp_path, make_position)
    with closing(unit.journal):
        yield unit


@contextmanager
def running(folder: Path, unit: Unit) -> Iterator[tuple[LiveStation, Backfill]]:
    """A station that hears the unit and may ask for its journal."""
    with LiveStation(folder) as station:
        server = JournalServer(U, unit.journal)
        station.router.attach_unit().serve(server.key_expression, server.replies)
        backfill = Backfill(station.bus, station.feed.deliver, SystemClock())
        backfill.start()
        try:
            yield station, backfill
        finally:
            station.feed.close()
            backfill.close()


def received(station: LiveStation, backfill: Backfill, rounds: int) -> None:
    """So many reports of what the station has."""
    for _ in range(rounds):
        station.reported = {}
        until(lambda: station.reported, "the unit is linked, and what there is of it is reported")
        backfill.report(station.reported)


def kept(station: LiveStation, unit: Unit) -> list[int]:
    """Count in the log of each of the journal's entries."""
    counts = Counter(payload for _, _, payload in station.log.records())
    return [counts[payload] for payload in unit.kept]


def test_unreadable_message_is_fetched_once_over_restarts(tmp_path: Path, unit: Unit) -> None:
    with running(tmp_path / "station", unit) as (station, backfill):
        station.act(RegisterUnit(U, "one"))
        station.publish(unit.position(1))
        received(station, backfill, 4)
        until(lambda: kept(station, unit) == [1] * len(unit.kept), "all is in the log")
        assert backfill.fetched == len(unit.kept)
        assert station.pipeline.state.counts.undecodable == 5
    with running(tmp_path / "station", unit) as (station, backfill):
        station.publish(unit.position(9))
        received(station, backfill, 4)
        assert backfill.fetched == 0
        assert kept(station, unit) == [1] * len(unit.kept)


def test_unreadable_message_received_live_is_not_fetched(tmp_path: Path, unit: Unit) -> None:
    newer = encode(unit.position(3, schema=SCHEMA_REVISION + 1))
    with LiveStation(tmp_path / "station") as station:
        station.act(RegisterUnit(U, "one"))
        for _ in range(2):
            station.feed.offer(POSITION.key(U), newer)
        until(lambda: station.pipeline.state.counts.undecodable == 1, "it came")
        state = station.pipeline.state
        until(lambda: (sender := state.sender(U)) and sender.has(BOOT, 3), "it is not missing")
        station.feed.deliver("muster/v1/FF-01/journal/up/position", newer)
        station.publish(unit.position(4))
        until(lambda: (sender := state.sender(U)) and sender.has(BOOT, 4), "the next one came")
        assert sum(payload == newer for _, _, payload in station.log.records()) == 1
