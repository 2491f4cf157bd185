"""A power cut of the station at the instant of an acknowledgement to a unit's journal loses
nothing.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import closing
from itertools import count
from pathlib import Path
from threading import Event, Thread

import pytest

from base_station.engine import engine as drive_module
from base_station.engine.feed import LiveFeed
from base_station.unit_sync import journal_client
from base_station.unit_sync.backfill import Backfill, Report
from base_station.unit_sync.durable_ack import DurableAckGate
from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import POSITION, backfilled_key
from shared.clock import NS_PER_S, SystemClock
from shared.codec import decode, encode
from shared.mcap_log import read_log, segment_paths
from shared.messages import Header, Position
from shared.messages.station import RegisterUnit
from tests.rig.live_station import LiveStation
from tests.rig.waiting import until

U, BOOT = "FF-01", 0xB007
CUTS = 4
MakePosition = Callable[..., Position]


class Disk:
    """Contents of each file after a power cut: the part that was synced."""

    def __init__(self) -> None:
        self._fsync = os.fsync
        self._kept: dict[Path, int] = {}

    def fsync(self, descriptor: int) -> None:
        size = os.fstat(descriptor).st_size
        self._fsync(descriptor)
        self._kept[Path(f"/proc/self/fd/{descriptor}").resolve()] = size

    def cut(self, log: Path, to: Path) -> None:
        to.mkdir()
        for path in segment_paths(log):
            shutil.copy(path, to)
            os.truncate(to / path.name, self._kept.get(path.resolve(), 0))


class Station(LiveStation):
    """Asks its unit's journal, as the real one does."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self._reports = DurableAckGate(self.recorder)
        self.backfill = Backfill(
            self.bus, self.feed.deliver, SystemClock(), self._reports.previous_report_is_durable
        )

    def _note_report(self, report: Report, in_memory: bool) -> None:
        self._reports.note_report_received()
        self.backfill.report(report, alerts_only=in_memory)


class Unit:
    """Speaks thirty times a second; every third message is lost on the air."""

    def __init__(self, folder: Path, make_position: MakePosition) -> None:
        self.journal = Journal(folder / "journal.sqlite", lambda: BOOT, 0, 10**9)
        self._make = make_position
        self._stop = Event()

    def speak(self, station: LiveStation) -> None:
        seq = 0
        while not self._stop.wait(0.03):
            seq += 1
            stated = self._make(header=Header(U, BOOT, seq, seq * NS_PER_S // 30))
            self.journal.append([JournalRow(seq, POSITION, seq, encode(stated))])
            if seq % 3:
                station.publish(stated)

    def close(self) -> None:
        self._stop.set()


def there(log: Path) -> set[int]:
    return {
        decode(POSITION, payload).header.seq
        for _, key, payload in read_log(log)
        if key.endswith(POSITION.suffix)
    }


@pytest.fixture
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports so soon after each other that the disk has not what the first one told of."""
    monkeypatch.setattr(drive_module, "TICK_NS", NS_PER_S // 10)
    monkeypatch.setattr(journal_client, "_ACKNOWLEDGE_EVERY_NS", NS_PER_S // 2)


@pytest.fixture
def unit(tmp_path: Path, make_position: MakePosition) -> Iterator[Unit]:
    unit = Unit(tmp_path, make_position)
    with closing(unit.journal):
        yield unit


def test_acknowledged_messages_are_in_the_log_after_a_power_cut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hasty: None, unit: Unit
) -> None:
    disk, cuts = Disk(), list[tuple[int, Path]]()
    monkeypatch.setattr("shared.mcap_log.durable_file.os.fsync", disk.fsync)
    server = JournalServer(U, unit.journal)
    with Station(tmp_path / "data") as station:

        def replies(key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
            if key.endswith("acknowledge"):
                stated = dict(pair.split("=") for pair in parameters.split(";"))
                to = tmp_path / f"cut-{len(cuts)}"
                disk.cut(station.recorder.folder, to)
                cuts.append((int(stated["to"]), to))
            return server.replies(key, parameters, payload)

        station.router.attach_unit().serve(server.key_expression, replies)
        station.act(RegisterUnit(U, "one"))
        station.backfill.start()
        speaking = Thread(target=unit.speak, args=(station,))
        speaking.start()
        try:
            until(lambda: len(cuts) >= CUTS)
        finally:
            unit.close()
            speaking.join()
            station.feed.close()
            station.backfill.close()
    assert cuts[-1][0] > 20
    for reported, log in cuts:
        assert set(range(1, reported + 1)) <= there(log)


def test_acknowledgements_to_other_units_continue_during_a_backlog(
    tmp_path: Path, hasty: None, unit: Unit, make_position: MakePosition
) -> None:
    server = JournalServer(U, unit.journal)
    ending = Event()

    def bring_for_long(feed: LiveFeed) -> None:
        """The backlog of another one that was out of reach for a shift."""
        for seq in count(1):
            if ending.is_set():
                return
            stated = make_position(header=Header("FF-02", BOOT, seq, seq))
            feed.deliver(backfilled_key("FF-02", POSITION.suffix), encode(stated))

    with Station(tmp_path / "data") as station:
        station.router.attach_unit().serve(server.key_expression, server.replies)
        for unit_id in (U, "FF-02"):
            station.act(RegisterUnit(unit_id, unit_id))
        bringing = Thread(target=bring_for_long, args=(station.feed,))
        bringing.start()
        station.backfill.start()
        speaking = Thread(target=unit.speak, args=(station,))
        speaking.start()
        try:
            until(lambda: unit.journal.last_seq - unit.journal.pending > 20, "they are told", 30.0)
        finally:
            ending.set()
            unit.close()
            station.feed.close()
            for thread in (bringing, speaking):
                thread.join()
            station.backfill.close()
