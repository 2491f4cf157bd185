"""The journal keeps its messages in order, and evicts by priority."""

from __future__ import annotations

import itertools
import shutil
import sqlite3
from collections.abc import Sequence
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from edge.storage.journal import database_file as journal_file
from edge.storage.journal import eviction
from edge.storage.journal import journal as journal_module
from edge.storage.journal.journal import Journal, JournalRow, open_journal
from edge.storage.journal.schema import RAW
from shared.channels import EVENT, IMU, POSITION, STATUS, Channel
from shared.errors import StoreError
from tests.rig.damaged_journal import spoil_page
from tests.rig.waiting import PATIENCE_S

MB = 1_000_000
PROMISING = ("journal_mode", "synchronous")


def spool_at(path: Path, boot_ids=None, limit_bytes: int = 100 * MB) -> Journal:
    draws = itertools.count(1) if boot_ids is None else iter(boot_ids)
    return Journal(path / "journal.sqlite", draws.__next__, 1_000, limit_bytes)


def entry(seq: int, channel: Channel = POSITION, size: int = 10) -> JournalRow:
    return JournalRow(seq, channel, 5_000, seq.to_bytes(8, "big") * (size // 8 + 1))


def seqs(journal: Journal, boot_id: int, first: int = 1, last: int = 10**9) -> list[int]:
    return [each.seq for each in journal.read(boot_id, first, last)]


def test_journal_returns_messages_of_all_channels_in_order(tmp_path):
    journal = spool_at(tmp_path)
    channels = itertools.cycle((POSITION, EVENT, IMU, STATUS))
    given = [entry(seq, channel) for seq, channel in zip(range(1, 201), channels, strict=False)]
    journal.append(given[:150])
    journal.append(given[150:])
    kept = list(journal.read(journal.boot_id, 1, 200))
    assert [(each.seq, each.suffix, each.payload) for each in kept] == [
        (each.seq, each.channel.suffix, each.payload) for each in given
    ]
    assert seqs(journal, journal.boot_id, 40, 60) == list(range(40, 61))
    journal.close()


def test_a_new_start_is_a_new_boot_and_the_old_one_is_still_served(tmp_path):
    first = spool_at(tmp_path)
    first.append([entry(seq, IMU if seq < 6 else EVENT) for seq in range(1, 11)])
    first.close()
    second = spool_at(tmp_path, boot_ids=[1, 1, 2])  # an id that was used is drawn again
    assert second.boot_id == 2
    second.append([entry(1)])
    assert [(boot.boot_id, boot.first_seq, boot.last_seq) for boot in second.boots()] == [
        (1, 1, 10),
        (2, 1, 1),
    ]
    assert seqs(second, 1) == list(range(1, 11))
    second.close()


def test_a_sequence_number_is_never_used_twice(tmp_path):
    journal = spool_at(tmp_path)
    journal.append([entry(1), entry(2)])
    with pytest.raises(StoreError):
        journal.append([entry(3), entry(2)])
    assert seqs(journal, journal.boot_id) == [1, 2]
    journal.close()


def test_room_is_made_from_the_least_worth_and_oldest(tmp_path):
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    channels = itertools.cycle((IMU, POSITION, IMU, IMU, STATUS, EVENT))
    for start in range(1, 3001, 50):
        journal.append([entry(seq, next(channels), 800) for seq in range(start, start + 50)])
    journal.append([entry(3001, EVENT)])  # room is made before
    kept = [(each.seq, each.suffix) for each in journal.read(journal.boot_id, 1, 3001)]
    by_suffix = {suffix: [seq for seq, of in kept if of == suffix] for _, suffix in kept}
    assert IMU.suffix not in by_suffix  # all raw data went before any position
    assert STATUS.suffix not in by_suffix
    assert len(by_suffix[EVENT.suffix]) == 501
    assert 100 < len(by_suffix[POSITION.suffix]) < 500
    assert by_suffix[POSITION.suffix] == list(range(2, 3001, 6))[-len(by_suffix[POSITION.suffix]) :]
    assert journal.rows_evicted == 3001 - len(kept)
    assert journal.first_seq == kept[0][0]
    assert sum(path.stat().st_size for path in tmp_path.iterdir()) < 8 * MB
    journal.close()


def test_raw_samples_go_before_anything_a_person_is_shown(tmp_path):
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    journal.append([entry(seq, STATUS, 800) for seq in range(1, 401)])
    for start in range(401, 1401, 250):
        journal.append([entry(seq, IMU, 800) for seq in range(start, start + 250)])
    assert journal.rows_evicted > 0
    assert seqs(journal, journal.boot_id, 1, 400) == list(range(1, 401))
    raw = [each.seq for each in journal.read(journal.boot_id, 1, 10**9, RAW)]
    assert raw == list(range(raw[0], 1401))
    assert raw[0] > 401
    journal.close()


def test_a_journal_that_has_nothing_of_this_boot_says_so(tmp_path):
    first = spool_at(tmp_path, boot_ids=[1])
    assert (first.first_seq, first.last_seq, first.rows_evicted, first.pending) == (1, 0, 0, 0)
    first.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
    first.close()
    second = spool_at(tmp_path, boot_ids=[2], limit_bytes=MB // 5)
    second.append([entry(seq, IMU, 800) for seq in range(1, 51)])
    second.append([entry(51, EVENT)])  # room is made of what is worth least: all of this boot
    assert second.first_seq == 51
    assert seqs(second, 2) == [51]
    second.close()


def test_acknowledged_messages_are_deleted_first(tmp_path):
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    journal.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
    journal.acknowledge(journal.boot_id, 600)
    assert journal.pending == 0
    for start in range(601, 1201, 50):
        journal.append([entry(seq, IMU, 800) for seq in range(start, start + 50)])
    assert journal.pending == 600
    kept = seqs(journal, journal.boot_id)
    assert kept == list(range(kept[0], 1201))
    assert 1 < kept[0] <= 601
    assert journal.first_seq == kept[0]
    assert journal.rows_evicted == 0  # nothing was given up that the station does not have
    journal.close()


def test_oldest_boot_of_acknowledged_messages_is_deleted_first(tmp_path):
    """Messages of the last boot, such as a mayday, are needed at the next start."""
    for boot_id in (1, 2):
        journal = spool_at(tmp_path, boot_ids=[boot_id])
        journal.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
        journal.acknowledge(boot_id, 600)
        journal.close()
    journal = spool_at(tmp_path, boot_ids=[3], limit_bytes=1 * MB)
    journal.append([entry(1, EVENT)])
    assert len(seqs(journal, 1)) < 600
    assert len(seqs(journal, 2)) == 600
    journal.close()


def test_room_is_made_for_more_than_the_next_message(tmp_path, monkeypatch):
    """It takes its time."""
    monkeypatch.setattr(eviction, "_ROWS_PER_STEP", 5)
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    journal.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
    journal.append([entry(1501)])
    monkeypatch.setattr(journal, "_evict", lambda: pytest.fail("there is room"))
    for seq in range(1502, 1522):
        journal.append([entry(seq, size=800)])
    journal.close()


def test_acknowledgement_of_an_earlier_boot_does_not_apply_to_this_one(tmp_path):
    first = spool_at(tmp_path, boot_ids=[1])
    first.append([entry(seq) for seq in range(1, 101)])
    first.close()
    second = spool_at(tmp_path, boot_ids=[2])
    second.append([entry(seq) for seq in range(1, 11)])
    second.acknowledge(1, 100)
    assert second.pending == 10
    second.acknowledge(2, 4)
    assert second.pending == 6
    second.acknowledge(2, 2)  # an answer that was overtaken
    assert second.pending == 6
    acknowledged = {boot.boot_id: boot.acknowledged_seq for boot in second.boots()}
    assert acknowledged == {1: 100, 2: 4}
    second.close()


def test_acknowledgement_of_future_messages_is_ignored(tmp_path):
    """Else it would be given up first, and nobody would have it."""
    journal = spool_at(tmp_path)
    journal.append([entry(1), entry(2)])
    journal.acknowledge(journal.boot_id, 10**6)
    assert journal.pending == 0
    journal.append([entry(3)])
    assert journal.pending == 1
    assert [boot.acknowledged_seq for boot in journal.boots()] == [2]
    journal.close()


@pytest.fixture
def steps(monkeypatch):
    """Counts what SQLite does on connections that are made from now on."""
    counted = [0]
    connect = journal_file.connect

    def count() -> int:
        counted[0] += 1
        return 0

    def connected(path: Path) -> sqlite3.Connection:
        connection = connect(path)
        connection.set_progress_handler(count, 1)
        return connection

    monkeypatch.setattr(journal_module, "connect", connected)
    return counted


def test_index_of_a_boot_is_given_without_reading_its_messages(tmp_path, steps):
    """The station asks every half minute, and a journal may have half a gigabyte."""
    journal = spool_at(tmp_path)
    journal.append([entry(1, channel) for channel in (IMU, POSITION)])
    steps[0] = 0
    journal.boots()
    with_few, steps[0] = steps[0], 0
    journal.append([entry(seq, IMU) for seq in range(2, 2000)])
    steps[0] = 0
    assert [(boot.first_seq, boot.last_seq) for boot in journal.boots()] == [(1, 1999)]
    assert steps[0] < 2 * with_few
    journal.close()


def test_boots_of_which_nothing_is_left_do_not_slow_the_making_of_room(
    tmp_path, steps, monkeypatch
):
    """A unit that has been started a thousand times knows of a thousand boots."""
    monkeypatch.setattr(eviction, "_ROWS_PER_STEP", 5)
    taken = []
    for number, boots in enumerate((1, 50)):
        folder = tmp_path / str(number)
        for boot_id in range(1, boots + 1):
            journal = spool_at(folder, boot_ids=[boot_id], limit_bytes=1 * MB)
            journal.acknowledge(boot_id, 1)
            journal.close()
        journal = spool_at(folder, boot_ids=[999], limit_bytes=1 * MB)
        journal.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
        steps[0] = 0
        journal.append([entry(1501)])
        assert journal.rows_evicted > 100
        taken.append(steps[0])
        journal.close()
    assert taken[1] < 5 * taken[0]


def test_failed_deletion_is_not_counted(tmp_path, monkeypatch):
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    journal.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
    with monkeypatch.context() as broken:
        free, calls = eviction._evict_rows, itertools.count(1)

        def refuse_then(*what: Any) -> int:
            if next(calls) == 2:
                raise sqlite3.OperationalError("disk I/O error")
            return free(*what)

        broken.setattr(eviction, "_evict_rows", refuse_then)
        with pytest.raises(StoreError, match="I/O"):
            journal.append([entry(1501)])
    assert len(seqs(journal, journal.boot_id)) == 1500
    assert journal.rows_evicted == 0
    journal.close()


def test_saved_messages_survive_a_power_cut(tmp_path):
    """No test can cut the power; this is what SQLite asks for to promise it."""
    journal = spool_at(tmp_path)
    reported = [journal._writer.execute(f"PRAGMA {name}").fetchone()[0] for name in PROMISING]
    assert reported == ["wal", 2]
    journal.close()


def test_a_full_disk_refuses_whole_groups_and_recovers(tmp_path):
    journal = spool_at(tmp_path)
    journal.append([entry(1)])
    (pages,) = journal._writer.execute("PRAGMA page_count").fetchone()
    journal._writer.execute(f"PRAGMA max_page_count = {pages + 2}")
    with pytest.raises(StoreError, match="full"):
        journal.append([entry(seq, size=4000) for seq in range(2, 20)])
    assert seqs(journal, journal.boot_id) == [1]
    journal._writer.execute("PRAGMA max_page_count = 1000000")
    journal.append([entry(seq, size=4000) for seq in range(2, 20)])
    assert seqs(journal, journal.boot_id) == list(range(1, 20))
    journal.close()


def test_a_disk_that_lets_no_room_be_made_is_written_again_when_it_does(tmp_path, monkeypatch):
    journal = spool_at(tmp_path, limit_bytes=1 * MB)
    journal.append([entry(seq, IMU, 800) for seq in range(1, 1501)])

    def refuse() -> None:
        raise sqlite3.OperationalError("disk I/O error")

    unsaved = [entry(1501)]
    with monkeypatch.context() as broken:
        broken.setattr(journal, "_evict", refuse)
        for seq in range(1502, 1505):  # as the outbox does: what failed is given again
            with pytest.raises(StoreError, match="I/O"):
                journal.append(unsaved)
            unsaved.append(entry(seq))
    journal.append(unsaved)
    assert seqs(journal, journal.boot_id, 1501) == [1501, 1502, 1503, 1504]
    journal.close()


@pytest.mark.parametrize("spoil_at", [0, 40])
def test_a_damaged_journal_is_set_aside_not_deleted(tmp_path, spoil_at):
    path = tmp_path / "journal.sqlite"
    journal = spool_at(tmp_path)
    journal.append([entry(1)])
    journal.close()
    content = bytearray(path.read_bytes())
    content[spoil_at:] = b"\xff" * (len(content) - spoil_at)
    path.write_bytes(content)
    journal, quarantine = open_journal(path, itertools.count(5).__next__, 77, MB)
    assert quarantine is not None
    assert quarantine.read_bytes() == content
    journal.append([entry(1)])
    assert seqs(journal, journal.boot_id) == [1]
    journal.close()


def spoil(path: Path, which: str) -> None:
    """A page of a journal of one boot."""
    journal = spool_at(path, boot_ids=[1])
    journal.append([entry(seq, EVENT, 800) for seq in range(1, 401)])
    journal.close()
    spoil_page(path / "journal.sqlite", which)


ROOT = "SELECT rootpage FROM sqlite_master WHERE name = 'message'"
OLDEST = "SELECT pageno FROM dbstat WHERE name = 'message' AND pagetype = 'leaf' ORDER BY path"


def test_a_journal_that_damage_keeps_from_being_written_is_begun_anew_at_once(tmp_path):
    """And is the journal from the next start on; the damaged one is kept beside it."""
    spoil(tmp_path, ROOT)
    path = tmp_path / "journal.sqlite"
    journal, quarantine = open_journal(path, itertools.count(2).__next__, 77, MB)
    assert quarantine is None
    journal.append([entry(1), entry(2)])
    journal.append([entry(3)])
    assert "malformed" in journal.damage
    assert seqs(journal, 2) == [1, 2, 3]
    assert journal.has_boot(2)
    assert not journal.has_boot(1)
    journal.close()
    again, quarantine = open_journal(path, itertools.count(3).__next__, 78, MB)
    assert quarantine is not None
    assert b"\xff" * 1000 in quarantine.read_bytes()
    assert again.damage == ""
    again.append([entry(1)])
    assert [(boot.boot_id, boot.first_seq, boot.last_seq) for boot in again.boots()] == [
        (2, 1, 3),
        (3, 1, 1),
    ]
    again.close()
    last, quarantine = open_journal(path, itertools.count(4).__next__, 79, MB)
    assert quarantine is None
    last.close()


def test_a_power_cut_while_the_new_journal_takes_its_place_costs_nothing(tmp_path):
    """Entries that are moved already, and not yet in the file itself, belong to the new one."""
    written, cut = tmp_path / "written", tmp_path / "cut" / "journal.sqlite"
    cut.parent.mkdir()
    running = spool_at(written, boot_ids=[1])
    running.append([entry(seq, EVENT) for seq in range(1, 101)])
    shutil.copy(written / "journal.sqlite", journal_file.replacement_of(cut))
    shutil.copy(written / "journal.sqlite-wal", cut.with_name("journal.sqlite-wal"))
    running.close()
    journal, _ = open_journal(cut, itertools.count(2).__next__, 77, MB)
    assert seqs(journal, 1) == list(range(1, 101))
    journal.close()


def test_a_journal_whose_boots_cannot_be_read_is_begun_anew(tmp_path):
    spoil(tmp_path, OLDEST)
    path = tmp_path / "journal.sqlite"
    journal, _ = open_journal(path, itertools.count(2).__next__, 77, MB)
    journal.append([entry(1, EVENT)])
    assert journal.damage == ""
    with pytest.raises(StoreError, match="malformed"):
        journal.boots()
    journal.append([entry(2, EVENT)])
    assert "malformed" in journal.damage
    assert [(boot.boot_id, boot.first_seq, boot.last_seq) for boot in journal.boots()] == [
        (2, 2, 2)
    ]
    assert journal.first_seq == 2
    journal.close()


def test_a_disk_that_damages_whatever_is_written_is_not_filled_with_journals(tmp_path, monkeypatch):
    journal = spool_at(tmp_path)

    def insert(_: object) -> None:
        error = sqlite3.DatabaseError("database disk image is malformed")
        error.sqlite_errorcode = sqlite3.SQLITE_CORRUPT
        raise error

    monkeypatch.setattr(journal, "_insert", insert)
    for seq in range(1, 4):
        with pytest.raises(StoreError, match="malformed"):
            journal.append([entry(seq)])
    journal.close()
    assert len(list(tmp_path.glob("*.anew*"))) <= 1


@pytest.mark.parametrize(
    "code",
    [
        sqlite3.SQLITE_FULL,
        sqlite3.SQLITE_IOERR_WRITE,
        sqlite3.SQLITE_READONLY,
        sqlite3.SQLITE_CANTOPEN,
    ],
)
def test_a_journal_that_the_disk_refuses_begins_when_there_is_room(tmp_path, monkeypatch, code):
    """It is left where it is: whole, with what the station may not have yet."""
    journal = spool_at(tmp_path)
    journal.append([entry(1)])
    journal.close()

    def refused(*_: object) -> bool:
        error = sqlite3.OperationalError("database or disk is full")
        error.sqlite_errorcode = code
        raise error

    path = tmp_path / "journal.sqlite"
    with monkeypatch.context() as disk:
        disk.setattr(Journal, "_begin_boot", refused)
        journal, quarantine = open_journal(path, itertools.count(5).__next__, 77, MB)
        assert quarantine is None
        for _ in range(2):
            with pytest.raises(StoreError, match="full"):
                journal.append([entry(1)])
        with pytest.raises(StoreError, match="full"):
            journal.acknowledge(1, 1)
        assert not journal.has_boot(journal.boot_id)
    journal.append([entry(1), entry(2)])
    assert seqs(journal, 1) == [1]
    assert seqs(journal, journal.boot_id) == [1, 2]
    assert [boot.started_utc_ns for boot in journal.boots()][-1] == 77
    journal.close()


def test_a_journal_that_never_began_is_closed_in_order(tmp_path, monkeypatch):
    def refused(*_: object) -> bool:
        error = sqlite3.OperationalError("disk I/O error")
        error.sqlite_errorcode = sqlite3.SQLITE_IOERR
        raise error

    monkeypatch.setattr(Journal, "_begin_boot", refused)
    spool_at(tmp_path).close()


def test_a_folder_that_cannot_be_written_is_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="cannot be used"):
        spool_at(tmp_path / "file")
    with pytest.raises(StoreError, match="cannot be used"):
        open_journal(tmp_path / "file" / "journal.sqlite", itertools.count(5).__next__, 77, MB)
    assert [one.name for one in tmp_path.iterdir()] == ["file"]


def test_a_disk_that_hangs_while_it_writes_keeps_no_question_waiting(tmp_path, monkeypatch):
    """The station's next one is about an alert; and whoever ends the unit waits for nobody."""
    monkeypatch.setattr(journal_module, "_LOCK_TIMEOUT_S", 0.01)
    monkeypatch.setattr(journal_module, "_CLOSING_S", 0.01)
    journal = spool_at(tmp_path)
    journal.append([entry(1), entry(2)])
    hangs, answers = Event(), Event()
    insert = journal._insert

    def hanging(messages: Sequence[JournalRow]) -> None:
        hangs.set()
        answers.wait(PATIENCE_S)
        insert(messages)

    monkeypatch.setattr(journal, "_insert", hanging)
    writing = Thread(target=journal.append, args=([entry(3)],))
    writing.start()
    hangs.wait(PATIENCE_S)
    with pytest.raises(StoreError, match="does not answer"):
        journal.acknowledge(journal.boot_id, 1)
    assert seqs(journal, journal.boot_id) == [1, 2]
    journal.close()
    assert writing.is_alive()
    answers.set()
    writing.join()
    assert seqs(journal, journal.boot_id) == [1, 2, 3]
