"""A full or hanging disk of a unit delays no message, is reported, and is written later."""

from __future__ import annotations

import errno
import shutil
import sqlite3
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import pytest

from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.sources.registry import open_source
from edge.storage.data_folder import UnitDataFolder
from edge.storage.journal.journal import Journal, JournalRow
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import EVENT, alive_key, parse_key
from shared.codec import decode
from shared.mcap_log import segment_paths
from shared.messages import EventKind, Heartbeat, Message, Position, UnitEvent
from tests.rig.hanging_disk import disk_that_can_hang, freeze, frozen, thaw
from tests.rig.waiting import until

ENDING_S = 15.0  # of the 20 s after which its service kills it


class Station:
    """The agent's other end, in memory; notes every message."""

    def __init__(self) -> None:
        self.router = MemoryRouter()
        self.messages: list[Message] = []
        self.is_alive = False
        bus = self.router.attach_station()
        bus.subscribe("muster/v1/u1/**", self._take)
        bus.watch_alive(alive_key("u1"), self._note_alive)

    def open_bus(self) -> Bus:
        return self.router.attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return "nobody is there"

    def how_it_stopped(self) -> str:
        return next(
            message.detail
            for message in reversed(self.messages)
            if isinstance(message, UnitEvent) and message.kind is EventKind.STOPPED
        )

    def _note_alive(self, key: str, is_alive: bool) -> None:
        self.is_alive = is_alive

    def _take(self, key: str, payload: bytes) -> None:
        self.messages.append(decode(parse_key(key)[1], payload))

    def count(self, kind: type[Message]) -> int:
        return sum(isinstance(message, kind) for message in list(self.messages))

    def heartbeats(self) -> list[Heartbeat]:
        return [message for message in list(self.messages) if isinstance(message, Heartbeat)]

    def faults(self) -> list[str]:
        return [
            message.detail
            for message in list(self.messages)
            if isinstance(message, UnitEvent) and message.kind is EventKind.STORAGE_FAULT
        ]


class AgentThread:
    """An agent in a thread, with its insides at hand."""

    def __init__(self, folder: Path) -> None:
        self.station = Station()
        self.data = UnitDataFolder(folder / "u1")
        config = EdgeConfig(unit="u1", source="simulated:search-ground-floor", data=folder)
        source = open_source(config.source)
        self.agent = compose_agent(config, "u1", self.data, source, self.station, speed=4.0)
        self.parts = self.agent._parts
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.agent.run, args=(self._stop,))
        self._thread.start()
        until(lambda: self.station.count(Position) > 5)

    def ordered_to_stop(self) -> None:
        self._stop.set()

    def ends_within(self, seconds: float) -> bool:
        self._stop.set()
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def end(self) -> None:
        self._stop.set()
        self._thread.join()
        self.data.close()


@pytest.fixture
def running(tmp_path):
    running = AgentThread(tmp_path)
    yield running
    running.end()


def set_room(running: AgentThread, pages: int) -> None:
    """Limits the size of the journal's file, like a full disk."""
    journal = running.parts.journal
    with journal._lock:
        journal._writer.execute(f"PRAGMA max_page_count = {pages}")


def test_full_disk_of_the_journal_is_reported_once(running):
    set_room(running, 1)
    until(running.station.faults)
    before = running.station.count(Position)
    until(lambda: running.station.count(Position) > before + 20)
    assert len(running.station.faults()) == 1
    assert "full" in running.station.faults()[0]

    set_room(running, 1_000_000)
    until(lambda: running.parts.journal_writer.fault is None)
    journal = running.parts.journal
    kept = [entry.seq for entry in journal.read(journal.boot_id, 1, 10**9)]
    assert kept == list(range(1, len(kept) + 1))
    assert running.parts.journal_writer.never_saved == 0


def test_messages_lost_on_a_full_disk_are_reported_in_the_heartbeat(running, monkeypatch):
    monkeypatch.setattr("edge.storage.journal.writer._UNSAVED_MAX", 3)
    set_room(running, 1)
    until(lambda: any(beat.never_saved > 0 for beat in running.station.heartbeats()))
    set_room(running, 1_000_000)
    assert running.station.heartbeats()[-1].given_up == 0


def test_full_disk_of_the_black_box_is_reported_once(running, monkeypatch):
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("shared.mcap_log.durable_file.os.pwrite", full)
        until(running.station.faults)
        assert "No space left" in running.station.faults()[0]
        before = running.station.count(Heartbeat)
        until(lambda: running.station.count(Heartbeat) > before + 2)
    until(lambda: running.parts.black_box.fault is None)
    assert len(running.station.faults()) == 1


def test_faults_of_journal_and_black_box_are_reported_separately(running, monkeypatch):
    """Somebody may have dealt with the first, and not know of the second."""

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("shared.mcap_log.durable_file.os.pwrite", full)
        until(running.station.faults)
        set_room(running, 1)
        until(lambda: len(running.station.faults()) > 1)
        assert "journal" in running.station.faults()[1]
        set_room(running, 1_000_000)


def test_journal_damaged_during_writing_is_replaced(running, monkeypatch):
    journal = running.parts.journal
    insert, had = journal._insert, journal.last_seq

    def spoilt(messages: Sequence[JournalRow]) -> None:
        if not journal.damage:
            error = sqlite3.DatabaseError("database disk image is malformed")
            error.sqlite_errorcode = sqlite3.SQLITE_CORRUPT
            raise error
        insert(messages)

    monkeypatch.setattr(journal, "_insert", spoilt)
    until(running.station.faults)
    assert "a new one is begun" in running.station.faults()[0]
    until(lambda: journal.last_seq > had + 20)
    kept = [entry.seq for entry in journal.read(journal.boot_id, 1, 10**9)]
    assert kept[0] > had
    assert kept == list(range(kept[0], kept[0] + len(kept)))
    assert running.parts.journal_writer.fault is None
    assert running.parts.journal_writer.never_saved == 0
    assert len(running.station.faults()) == 1


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    """A small disk of its own."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=32m", "muster-test", str(place)]
    try:
        subprocess.run(mount, check=True, capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"no disk can be mounted here: {error}")
    yield place
    subprocess.run(["umount", "--lazy", str(place)], check=True)  # a test that failed holds it


@pytest.fixture
def freezing_disk(tmp_path: Path) -> Iterator[Path]:
    with disk_that_can_hang(tmp_path, size_mb=64) as place:
        yield place


def remount(disk: Path, how: str) -> None:
    subprocess.run(["mount", "-o", f"remount,{how}", str(disk)], check=True)


def fill(disk: Path) -> None:
    with (disk / "filler").open("wb", buffering=0) as filler, suppress(OSError):
        while filler.write(bytes(4096)):
            pass


def started_before(disk: Path) -> None:
    running = AgentThread(disk)
    until(lambda: running.parts.journal.last_seq > 20)
    running.end()


@pytest.mark.parametrize("knows_the_disk", [True, False])
def test_a_unit_that_is_started_with_a_full_disk_is_received(
    disk: Path, knows_the_disk: bool
) -> None:
    if knows_the_disk:
        started_before(disk)
    else:
        (disk / "u1").mkdir()
    fill(disk)
    running = AgentThread(disk)
    try:
        assert_reported_and_made_good(running, (disk / "filler").unlink)
    finally:
        running.end()


def test_disk_full_of_old_recordings_keeps_the_journal(disk: Path) -> None:
    """Though the black box may have more than the whole of this disk."""
    started_before(disk)
    (recorded,) = (disk / "u1" / "black_box").iterdir()
    old = [recorded.with_name(f"20200101T00000{number}Z-{number:016x}") for number in range(9)]
    for one in old:
        shutil.copytree(recorded, one)
        (segment,) = segment_paths(one)
        with segment.open("ab") as file:
            file.write(bytes(1_000_000))
    fill(disk)
    running = AgentThread(disk)
    try:
        until(lambda: (disk / "u1" / "journal.sqlite-wal").stat().st_size > 0)
        journal = running.parts.journal
        until(lambda: journal.last_seq > 100 and running.parts.journal_writer.fault is None)
        until(lambda: running.parts.black_box.fault is None)
        assert running.parts.journal_writer.never_saved == 0
        kept = [one for one in (recorded, *old) if one.exists()]
        assert 0 < len(kept) <= len(old)
    finally:
        running.end()


def test_unit_with_a_read_only_disk_is_received(disk: Path) -> None:
    started_before(disk)
    remount(disk, "ro")
    running = AgentThread(disk)
    try:
        assert_reported_and_made_good(running, lambda: remount(disk, "rw"))
    finally:
        running.end()


def test_unit_with_a_hanging_disk_is_received(freezing_disk: Path) -> None:
    running = AgentThread(freezing_disk)
    freeze(freezing_disk)
    try:
        assert_reported_and_made_good(running, lambda: thaw(freezing_disk))
    finally:
        with suppress(subprocess.CalledProcessError):
            thaw(freezing_disk)
        running.end()


def test_unit_with_a_hanging_disk_stops_on_request(
    freezing_disk: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Its service would kill it in the end, and the station would never hear that it was meant."""
    running = AgentThread(freezing_disk)
    with frozen(freezing_disk):
        until(running.station.faults)
        assert running.ends_within(ENDING_S)
        assert running.station.how_it_stopped() == "stopped by a signal"
        assert not running.station.is_alive
    reported = [record.getMessage() for record in caplog.records]
    assert any("messages are not kept" in one for one in reported)


def test_messages_waiting_for_the_disk_at_shutdown_are_saved(freezing_disk: Path) -> None:
    running = AgentThread(freezing_disk)
    with frozen(freezing_disk):
        time.sleep(1.5)
        running.ordered_to_stop()
        time.sleep(1.0)
    assert running.ends_within(ENDING_S)
    journal = Journal(freezing_disk / "u1" / "journal.sqlite", lambda: 1, 0, 10**9)
    try:
        (boot,) = journal.boots()
        kept = list(journal.read(boot.boot_id, 1, boot.last_seq))
    finally:
        journal.close()
    assert [entry.seq for entry in kept] == list(range(1, len(kept) + 1))
    last = decode(EVENT, kept[-1].payload)
    assert isinstance(last, UnitEvent)
    assert last.kind is EventKind.STOPPED


def assert_reported_and_made_good(running: AgentThread, mend: Callable[[], object]) -> None:
    until(running.station.faults)
    before = running.station.count(Position)
    until(lambda: running.station.count(Position) > before + 20)
    mend()
    until(lambda: running.parts.journal_writer.fault is None)
    until(lambda: running.parts.black_box.fault is None)
    journal = running.parts.journal
    kept = [entry.seq for entry in journal.read(journal.boot_id, 1, 10**9)]
    assert kept == list(range(1, len(kept) + 1))
    assert running.parts.journal_writer.never_saved == 0
