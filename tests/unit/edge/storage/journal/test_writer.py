"""Messages are on the disk, or wait in memory for one that refuses or hangs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

import pytest

from edge.storage.journal.journal import Journal, JournalRow
from shared.channels import EVENT, TEMPERATURE
from shared.errors import StoreError
from tests.rig.waiting import PATIENCE_S, until


@pytest.fixture
def full_disk(journal, monkeypatch):
    """While it is entered, the disk takes nothing."""

    def refuse(messages):
        raise StoreError("the disk is full")

    @contextmanager
    def full():
        with monkeypatch.context() as patch:
            patch.setattr(journal, "append", refuse)
            yield

    return full


@pytest.fixture
def hanging_disk(journal, monkeypatch):
    """While it is entered, the disk does not answer; afterwards it does what it was asked."""
    append = journal.append

    @contextmanager
    def hanging() -> Iterator[Event]:
        is_asked, answers = Event(), Event()

        def wait(messages):
            is_asked.set()
            answers.wait(PATIENCE_S)
            append(messages)

        with monkeypatch.context() as patch:
            patch.setattr(journal, "append", wait)
            try:
                yield is_asked
            finally:
                answers.set()

    return hanging


def stated(seq: int) -> JournalRow:
    return JournalRow(seq, TEMPERATURE, 0, b"20 degC")


def mayday(seq: int) -> JournalRow:
    return JournalRow(seq, EVENT, 0, b"mayday")


def kept(journal: Journal) -> list[int]:
    return [entry.seq for entry in journal.read(journal.boot_id, 1, 10**6)]


def test_saved_message_is_not_written_again(journal, journal_writer, monkeypatch):
    written: list[int] = []
    append = journal.append

    def count(messages):
        written.extend(message.seq for message in messages)
        append(messages)

    monkeypatch.setattr(journal, "append", count)
    for seq in (1, 2, 3):
        journal_writer.write([mayday(seq)])
        assert kept(journal) == list(range(1, seq + 1))
    assert written == [1, 2, 3]
    assert journal_writer.never_saved == 0
    assert journal_writer.fault is None


def test_messages_refused_by_a_full_disk_are_written_when_there_is_room(
    journal, journal_writer, full_disk
):
    with full_disk():
        journal_writer.write([stated(1), stated(2)])
        assert "the disk is full" in str(journal_writer.fault)
        assert journal_writer.is_working
    journal_writer.write([stated(3)])
    journal_writer.close()
    assert kept(journal) == [1, 2, 3]
    assert journal_writer.never_saved == 0
    assert journal_writer.fault is None


def test_failed_write_ends_the_wait_of_the_sender(journal, journal_writer, monkeypatch, full_disk):
    """Otherwise every message would be sent a second late."""
    monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 1e6)
    journal_writer.write([mayday(1)])
    assert kept(journal) == [1]
    with full_disk():
        journal_writer.write([mayday(2)])
        journal_writer.write([mayday(3)])
        assert journal_writer.fault is not None
    assert kept(journal) == [1]


def test_a_disk_that_has_just_refused_is_not_asked_at_every_message(
    journal, journal_writer, monkeypatch
):
    """Thousands wait: to offer them ten times a second leaves the tracker no processor."""
    offered: list[int] = []
    append = journal.append

    def refuse(messages):
        offered.append(len(messages))
        raise StoreError("the disk is full")

    monkeypatch.setattr("edge.storage.journal.writer._RETRY_S", 600.0)
    monkeypatch.setattr(journal, "append", refuse)
    for seq in range(1, 6):
        journal_writer.write([mayday(seq)])
    assert offered == [1]
    monkeypatch.setattr(journal, "append", append)
    journal_writer.close()
    assert kept(journal) == [1, 2, 3, 4, 5]


def test_a_disk_that_has_refused_is_asked_again_though_nothing_more_is_stated(
    journal, journal_writer, monkeypatch, full_disk
):
    monkeypatch.setattr("edge.storage.journal.writer._RETRY_S", 0.01)
    with full_disk():
        journal_writer.write([stated(1)])
    until(lambda: kept(journal) == [1])
    until(lambda: journal_writer.fault is None)


def test_an_alert_is_not_ousted_by_what_came_after_it(
    journal, journal_writer, monkeypatch, full_disk
):
    """Neither a disk nor a link for minutes: the mayday is what must not be missing."""
    monkeypatch.setattr("edge.storage.journal.writer._UNSAVED_MAX", 3)
    with full_disk():
        journal_writer.write([mayday(1)])
        journal_writer.write(map(stated, range(2, 7)))
    journal_writer.write([stated(7)])
    journal_writer.close()
    assert kept(journal) == [1, 5, 6, 7]
    assert journal_writer.never_saved == 3


def test_messages_lost_on_a_full_disk_are_counted_and_reported(
    journal, journal_writer, monkeypatch, caplog, full_disk
):
    monkeypatch.setattr("edge.storage.journal.writer._UNSAVED_MAX", 3)
    with full_disk():
        for seq in range(1, 6):
            journal_writer.write([mayday(seq)])
    journal_writer.write([mayday(6)])
    journal_writer.close()
    assert kept(journal) == [4, 5, 6]
    assert journal_writer.never_saved == 3
    reported = [record.getMessage() for record in caplog.records]
    assert reported[1:] == [
        "the journal can be written again; 3 messages were sent and not kept since the start"
    ]


def test_a_disk_that_hangs_is_not_waited_for(journal, journal_writer, monkeypatch, hanging_disk):
    monkeypatch.setattr("edge.storage.disk_watchdog.HANGS_S", 0.0)
    with hanging_disk() as is_asked:
        monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 0.05)
        journal_writer.write([stated(1)])
        monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 0.0)
        is_asked.wait(PATIENCE_S)
        monkeypatch.setattr(journal_writer._changed, "wait_for", lambda *_: pytest.fail("it waits"))
        for seq in (2, 3, 4):
            journal_writer.write([stated(seq)])
        assert "has not answered" in str(journal_writer.fault)
        monkeypatch.undo()
    until(lambda: kept(journal) == [1, 2, 3, 4])
    until(lambda: journal_writer.fault is None)
    assert journal_writer.never_saved == 0


def test_messages_being_written_to_a_hanging_disk_are_kept_once(
    journal, journal_writer, monkeypatch, hanging_disk
):
    monkeypatch.setattr("edge.storage.journal.writer._UNSAVED_MAX", 2)
    monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 0.01)
    with hanging_disk() as is_asked:
        journal_writer.write([stated(1), stated(2)])
        is_asked.wait(PATIENCE_S)
        journal_writer.write(map(stated, range(3, 8)))
    until(lambda: kept(journal) == [1, 2, 6, 7])
    assert journal_writer.never_saved == 3


def test_a_disk_that_is_slow_now_and_then_is_no_fault(
    journal, journal_writer, monkeypatch, hanging_disk
):
    monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 0.01)
    with hanging_disk():
        journal_writer.write([stated(1)])
        journal_writer.write([stated(2)])
        assert journal_writer.fault is None


def test_the_end_does_not_wait_for_a_disk_that_hangs(
    journal, journal_writer, monkeypatch, hanging_disk
):
    monkeypatch.setattr("edge.storage.disk_watchdog.HANGS_S", 0.3)
    monkeypatch.setattr("edge.storage.journal.writer._WRITE_TIMEOUT_S", 0.01)
    with hanging_disk() as is_asked:
        journal_writer.write([stated(1)])
        is_asked.wait(PATIENCE_S)
        closing = Thread(target=journal_writer.close)
        closing.start()
        closing.join(PATIENCE_S / 2)
        assert not closing.is_alive()
