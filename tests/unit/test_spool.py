"""The journal keeps what it was given, in order, and makes room by worth."""

from __future__ import annotations

import itertools
import shutil
import sqlite3
from collections.abc import Sequence
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from edge.journal import file as journal_file
from edge.journal import room as journal_room
from edge.journal import spool as spool_module
from edge.journal.rows import RAW
from edge.journal.spool import Journaled, Spool, open_spool
from shared.channels import EVENT, IMU, POSITION, STATUS, Channel
from shared.errors import StoreError
from tests.spoiled_journal import spoil_page
from tests.waiting import PATIENCE_S

MB = 1_000_000
PROMISING = ("journal_mode", "synchronous")


def spool_at(path: Path, boot_ids=None, limit_bytes: int = 100 * MB) -> Spool:
    draws = itertools.count(1) if boot_ids is None else iter(boot_ids)
    return Spool(path / "journal.sqlite", draws.__next__, 1_000, limit_bytes)


def entry(seq: int, channel: Channel = POSITION, size: int = 10) -> Journaled:
    return Journaled(seq, channel, 5_000, seq.to_bytes(8, "big") * (size // 8 + 1))


def seqs(spool: Spool, boot_id: int, first: int = 1, last: int = 10**9) -> list[int]:
    return [each.seq for each in spool.read(boot_id, first, last)]


def test_it_gives_back_what_it_was_given_in_order_over_all_channels(tmp_path):
    spool = spool_at(tmp_path)
    channels = itertools.cycle((POSITION, EVENT, IMU, STATUS))
    given = [entry(seq, channel) for seq, channel in zip(range(1, 201), channels, strict=False)]
    spool.append(given[:150])
    spool.append(given[150:])
    kept = list(spool.read(spool.boot_id, 1, 200))
    assert [(each.seq, each.suffix, each.payload) for each in kept] == [
        (each.seq, each.channel.suffix, each.payload) for each in given
    ]
    assert seqs(spool, spool.boot_id, 40, 60) == list(range(40, 61))
    spool.close()


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
    spool = spool_at(tmp_path)
    spool.append([entry(1), entry(2)])
    with pytest.raises(StoreError):
        spool.append([entry(3), entry(2)])
    assert seqs(spool, spool.boot_id) == [1, 2]
    spool.close()


def test_room_is_made_from_the_least_worth_and_oldest(tmp_path):
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    channels = itertools.cycle((IMU, POSITION, IMU, IMU, STATUS, EVENT))
    for start in range(1, 3001, 50):
        spool.append([entry(seq, next(channels), 800) for seq in range(start, start + 50)])
    spool.append([entry(3001, EVENT)])  # room is made before
    kept = [(each.seq, each.suffix) for each in spool.read(spool.boot_id, 1, 3001)]
    by_suffix = {suffix: [seq for seq, of in kept if of == suffix] for _, suffix in kept}
    assert IMU.suffix not in by_suffix  # all raw data went before any position
    assert STATUS.suffix not in by_suffix
    assert len(by_suffix[EVENT.suffix]) == 501
    assert 100 < len(by_suffix[POSITION.suffix]) < 500
    assert by_suffix[POSITION.suffix] == list(range(2, 3001, 6))[-len(by_suffix[POSITION.suffix]) :]
    assert spool.rows_freed == 3001 - len(kept)
    assert spool.first_seq == kept[0][0]
    assert sum(path.stat().st_size for path in tmp_path.iterdir()) < 8 * MB
    spool.close()


def test_raw_samples_go_before_anything_a_person_is_shown(tmp_path):
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    spool.append([entry(seq, STATUS, 800) for seq in range(1, 401)])
    for start in range(401, 1401, 250):
        spool.append([entry(seq, IMU, 800) for seq in range(start, start + 250)])
    assert spool.rows_freed > 0
    assert seqs(spool, spool.boot_id, 1, 400) == list(range(1, 401))
    raw = [each.seq for each in spool.read(spool.boot_id, 1, 10**9, RAW)]
    assert raw == list(range(raw[0], 1401))
    assert raw[0] > 401
    spool.close()


def test_a_journal_that_has_nothing_of_this_boot_says_so(tmp_path):
    first = spool_at(tmp_path, boot_ids=[1])
    assert (first.first_seq, first.last_seq, first.rows_freed, first.pending) == (1, 0, 0, 0)
    first.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
    first.close()
    second = spool_at(tmp_path, boot_ids=[2], limit_bytes=MB // 5)
    second.append([entry(seq, IMU, 800) for seq in range(1, 51)])
    second.append([entry(51, EVENT)])  # room is made of what is worth least: all of this boot
    assert second.first_seq == 51
    assert seqs(second, 2) == [51]
    second.close()


def test_what_the_station_has_goes_first(tmp_path):
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    spool.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
    spool.acknowledge(spool.boot_id, 600)
    assert spool.pending == 0
    for start in range(601, 1201, 50):
        spool.append([entry(seq, IMU, 800) for seq in range(start, start + 50)])
    assert spool.pending == 600
    kept = seqs(spool, spool.boot_id)
    assert kept == list(range(kept[0], 1201))
    assert 1 < kept[0] <= 601
    assert spool.first_seq == kept[0]
    assert spool.rows_freed == 0  # nothing was given up that the station does not have
    spool.close()


def test_of_what_the_station_has_the_oldest_boot_goes_first(tmp_path):
    """What the last one said, such as a mayday, is still to be known at the next start."""
    for boot_id in (1, 2):
        spool = spool_at(tmp_path, boot_ids=[boot_id])
        spool.append([entry(seq, EVENT, 800) for seq in range(1, 601)])
        spool.acknowledge(boot_id, 600)
        spool.close()
    spool = spool_at(tmp_path, boot_ids=[3], limit_bytes=1 * MB)
    spool.append([entry(1, EVENT)])
    assert len(seqs(spool, 1)) < 600
    assert len(seqs(spool, 2)) == 600
    spool.close()


def test_room_is_made_for_more_than_the_next_message(tmp_path, monkeypatch):
    """It takes its time."""
    monkeypatch.setattr(journal_room, "_ROWS_FREED_AT_ONCE", 5)
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    spool.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
    spool.append([entry(1501)])
    monkeypatch.setattr(spool, "_make_room", lambda: pytest.fail("there is room"))
    for seq in range(1502, 1522):
        spool.append([entry(seq, size=800)])
    spool.close()


def test_what_the_station_has_of_an_earlier_boot_says_nothing_of_this_one(tmp_path):
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


def test_what_is_still_to_come_cannot_have_been_acknowledged(tmp_path):
    """Else it would be given up first, and nobody would have it."""
    spool = spool_at(tmp_path)
    spool.append([entry(1), entry(2)])
    spool.acknowledge(spool.boot_id, 10**6)
    assert spool.pending == 0
    spool.append([entry(3)])
    assert spool.pending == 1
    assert [boot.acknowledged_seq for boot in spool.boots()] == [2]
    spool.close()


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

    monkeypatch.setattr(spool_module, "connect", connected)
    return counted


def test_what_there_is_of_a_boot_is_said_without_reading_it(tmp_path, steps):
    """The station asks every half minute, and a journal may have half a gigabyte."""
    spool = spool_at(tmp_path)
    spool.append([entry(1, channel) for channel in (IMU, POSITION)])
    steps[0] = 0
    spool.boots()
    with_few, steps[0] = steps[0], 0
    spool.append([entry(seq, IMU) for seq in range(2, 2000)])
    steps[0] = 0
    assert [(boot.first_seq, boot.last_seq) for boot in spool.boots()] == [(1, 1999)]
    assert steps[0] < 2 * with_few
    spool.close()


def test_boots_of_which_nothing_is_left_do_not_slow_the_making_of_room(
    tmp_path, steps, monkeypatch
):
    """A unit that has been started a thousand times knows of a thousand boots."""
    monkeypatch.setattr(journal_room, "_ROWS_FREED_AT_ONCE", 5)
    taken = []
    for number, boots in enumerate((1, 50)):
        folder = tmp_path / str(number)
        for boot_id in range(1, boots + 1):
            spool = spool_at(folder, boot_ids=[boot_id], limit_bytes=1 * MB)
            spool.acknowledge(boot_id, 1)
            spool.close()
        spool = spool_at(folder, boot_ids=[999], limit_bytes=1 * MB)
        spool.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
        steps[0] = 0
        spool.append([entry(1501)])
        assert spool.rows_freed > 100
        taken.append(steps[0])
        spool.close()
    assert taken[1] < 5 * taken[0]


def test_what_could_not_be_given_up_after_all_is_not_counted(tmp_path, monkeypatch):
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    spool.append([entry(seq, IMU, 800) for seq in range(1, 1501)])
    with monkeypatch.context() as broken:
        free, calls = journal_room._free, itertools.count(1)

        def refuse_then(*what: Any) -> int:
            if next(calls) == 2:
                raise sqlite3.OperationalError("disk I/O error")
            return free(*what)

        broken.setattr(journal_room, "_free", refuse_then)
        with pytest.raises(StoreError, match="I/O"):
            spool.append([entry(1501)])
    assert len(seqs(spool, spool.boot_id)) == 1500
    assert spool.rows_freed == 0
    spool.close()


def test_what_is_safe_outlives_a_power_cut(tmp_path):
    """No test can cut the power; this is what SQLite asks for to promise it."""
    spool = spool_at(tmp_path)
    said = [spool._writer.execute(f"PRAGMA {name}").fetchone()[0] for name in PROMISING]
    assert said == ["wal", 2]
    spool.close()


def test_a_full_disk_refuses_whole_groups_and_recovers(tmp_path):
    spool = spool_at(tmp_path)
    spool.append([entry(1)])
    (pages,) = spool._writer.execute("PRAGMA page_count").fetchone()
    spool._writer.execute(f"PRAGMA max_page_count = {pages + 2}")
    with pytest.raises(StoreError, match="full"):
        spool.append([entry(seq, size=4000) for seq in range(2, 20)])
    assert seqs(spool, spool.boot_id) == [1]
    spool._writer.execute("PRAGMA max_page_count = 1000000")
    spool.append([entry(seq, size=4000) for seq in range(2, 20)])
    assert seqs(spool, spool.boot_id) == list(range(1, 20))
    spool.close()


def test_a_disk_that_lets_no_room_be_made_is_written_again_when_it_does(tmp_path, monkeypatch):
    spool = spool_at(tmp_path, limit_bytes=1 * MB)
    spool.append([entry(seq, IMU, 800) for seq in range(1, 1501)])

    def refuse() -> None:
        raise sqlite3.OperationalError("disk I/O error")

    unsaved = [entry(1501)]
    with monkeypatch.context() as broken:
        broken.setattr(spool, "_make_room", refuse)
        for seq in range(1502, 1505):  # as the outbox does: what failed is given again
            with pytest.raises(StoreError, match="I/O"):
                spool.append(unsaved)
            unsaved.append(entry(seq))
    spool.append(unsaved)
    assert seqs(spool, spool.boot_id, 1501) == [1501, 1502, 1503, 1504]
    spool.close()


@pytest.mark.parametrize("spoil_at", [0, 40])
def test_a_damaged_journal_is_set_aside_not_deleted(tmp_path, spoil_at):
    path = tmp_path / "journal.sqlite"
    spool = spool_at(tmp_path)
    spool.append([entry(1)])
    spool.close()
    content = bytearray(path.read_bytes())
    content[spoil_at:] = b"\xff" * (len(content) - spoil_at)
    path.write_bytes(content)
    spool, aside = open_spool(path, itertools.count(5).__next__, 77, MB)
    assert aside is not None
    assert aside.read_bytes() == content
    spool.append([entry(1)])
    assert seqs(spool, spool.boot_id) == [1]
    spool.close()


def spoil(path: Path, which: str) -> None:
    """A page of a journal of one boot."""
    spool = spool_at(path, boot_ids=[1])
    spool.append([entry(seq, EVENT, 800) for seq in range(1, 401)])
    spool.close()
    spoil_page(path / "journal.sqlite", which)


ROOT = "SELECT rootpage FROM sqlite_master WHERE name = 'message'"
OLDEST = "SELECT pageno FROM dbstat WHERE name = 'message' AND pagetype = 'leaf' ORDER BY path"


def test_a_journal_that_damage_keeps_from_being_written_is_begun_anew_at_once(tmp_path):
    """And is the journal from the next start on; the damaged one is kept beside it."""
    spoil(tmp_path, ROOT)
    path = tmp_path / "journal.sqlite"
    spool, aside = open_spool(path, itertools.count(2).__next__, 77, MB)
    assert aside is None
    spool.append([entry(1), entry(2)])
    spool.append([entry(3)])
    assert "malformed" in spool.damage
    assert seqs(spool, 2) == [1, 2, 3]
    assert spool.has_boot(2)
    assert not spool.has_boot(1)
    spool.close()
    again, aside = open_spool(path, itertools.count(3).__next__, 78, MB)
    assert aside is not None
    assert b"\xff" * 1000 in aside.read_bytes()
    assert again.damage == ""
    again.append([entry(1)])
    assert [(boot.boot_id, boot.first_seq, boot.last_seq) for boot in again.boots()] == [
        (2, 1, 3),
        (3, 1, 1),
    ]
    again.close()
    last, aside = open_spool(path, itertools.count(4).__next__, 79, MB)
    assert aside is None
    last.close()


def test_a_power_cut_while_the_new_journal_takes_its_place_costs_nothing(tmp_path):
    """What is not in the file itself yet, and has been moved already, belongs to the new one."""
    written, cut = tmp_path / "written", tmp_path / "cut" / "journal.sqlite"
    cut.parent.mkdir()
    running = spool_at(written, boot_ids=[1])
    running.append([entry(seq, EVENT) for seq in range(1, 101)])
    shutil.copy(written / "journal.sqlite", journal_file.anew(cut))
    shutil.copy(written / "journal.sqlite-wal", cut.with_name("journal.sqlite-wal"))
    running.close()
    spool, _ = open_spool(cut, itertools.count(2).__next__, 77, MB)
    assert seqs(spool, 1) == list(range(1, 101))
    spool.close()


def test_a_journal_of_which_nobody_can_be_told_what_is_in_it_is_begun_anew(tmp_path):
    spoil(tmp_path, OLDEST)
    path = tmp_path / "journal.sqlite"
    spool, _ = open_spool(path, itertools.count(2).__next__, 77, MB)
    spool.append([entry(1, EVENT)])
    assert spool.damage == ""
    with pytest.raises(StoreError, match="malformed"):
        spool.boots()
    spool.append([entry(2, EVENT)])
    assert "malformed" in spool.damage
    assert [(boot.boot_id, boot.first_seq, boot.last_seq) for boot in spool.boots()] == [(2, 2, 2)]
    assert spool.first_seq == 2
    spool.close()


def test_a_disk_that_damages_whatever_is_written_is_not_filled_with_journals(tmp_path, monkeypatch):
    spool = spool_at(tmp_path)

    def insert(_: object) -> None:
        error = sqlite3.DatabaseError("database disk image is malformed")
        error.sqlite_errorcode = sqlite3.SQLITE_CORRUPT
        raise error

    monkeypatch.setattr(spool, "_insert", insert)
    for seq in range(1, 4):
        with pytest.raises(StoreError, match="malformed"):
            spool.append([entry(seq)])
    spool.close()
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
    spool = spool_at(tmp_path)
    spool.append([entry(1)])
    spool.close()

    def refused(*_: object) -> bool:
        error = sqlite3.OperationalError("database or disk is full")
        error.sqlite_errorcode = code
        raise error

    path = tmp_path / "journal.sqlite"
    with monkeypatch.context() as disk:
        disk.setattr(Spool, "_begin_boot", refused)
        spool, aside = open_spool(path, itertools.count(5).__next__, 77, MB)
        assert aside is None
        for _ in range(2):
            with pytest.raises(StoreError, match="full"):
                spool.append([entry(1)])
        with pytest.raises(StoreError, match="full"):
            spool.acknowledge(1, 1)
        assert not spool.has_boot(spool.boot_id)
    spool.append([entry(1), entry(2)])
    assert seqs(spool, 1) == [1]
    assert seqs(spool, spool.boot_id) == [1, 2]
    assert [boot.started_utc_ns for boot in spool.boots()][-1] == 77
    spool.close()


def test_a_journal_that_never_began_is_closed_in_order(tmp_path, monkeypatch):
    def refused(*_: object) -> bool:
        error = sqlite3.OperationalError("disk I/O error")
        error.sqlite_errorcode = sqlite3.SQLITE_IOERR
        raise error

    monkeypatch.setattr(Spool, "_begin_boot", refused)
    spool_at(tmp_path).close()


def test_a_folder_that_cannot_be_written_is_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="cannot be used"):
        spool_at(tmp_path / "file")
    with pytest.raises(StoreError, match="cannot be used"):
        open_spool(tmp_path / "file" / "journal.sqlite", itertools.count(5).__next__, 77, MB)
    assert [one.name for one in tmp_path.iterdir()] == ["file"]


def test_a_disk_that_hangs_while_it_writes_keeps_no_question_waiting(tmp_path, monkeypatch):
    """The station's next one is about an alert; and whoever ends the unit waits for nobody."""
    monkeypatch.setattr(spool_module, "_PATIENCE_S", 0.01)
    monkeypatch.setattr(spool_module, "_CLOSING_S", 0.01)
    spool = spool_at(tmp_path)
    spool.append([entry(1), entry(2)])
    hangs, answers = Event(), Event()
    insert = spool._insert

    def hanging(messages: Sequence[Journaled]) -> None:
        hangs.set()
        answers.wait(PATIENCE_S)
        insert(messages)

    monkeypatch.setattr(spool, "_insert", hanging)
    writing = Thread(target=spool.append, args=([entry(3)],))
    writing.start()
    hangs.wait(PATIENCE_S)
    with pytest.raises(StoreError, match="does not answer"):
        spool.acknowledge(spool.boot_id, 1)
    assert seqs(spool, spool.boot_id) == [1, 2]
    spool.close()
    assert writing.is_alive()
    answers.set()
    writing.join()
    assert seqs(spool, spool.boot_id) == [1, 2, 3]
