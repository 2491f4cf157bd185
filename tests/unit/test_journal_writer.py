"""What is written is on the disk, or waits in memory for one that refuses or hangs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

import pytest

from edge.journal.spool import Journaled, Spool
from shared.channels import EVENT, TEMPERATURE
from shared.errors import StoreError
from tests.waiting import PATIENCE_S, until


@pytest.fixture
def full_disk(spool, monkeypatch):
    """While it is entered, the disk takes nothing."""

    def refuse(messages):
        raise StoreError("the disk is full")

    @contextmanager
    def full():
        with monkeypatch.context() as patch:
            patch.setattr(spool, "append", refuse)
            yield

    return full


@pytest.fixture
def hanging_disk(spool, monkeypatch):
    """While it is entered, the disk does not answer; afterwards it does what it was asked."""
    append = spool.append

    @contextmanager
    def hanging() -> Iterator[Event]:
        is_asked, answers = Event(), Event()

        def wait(messages):
            is_asked.set()
            answers.wait(PATIENCE_S)
            append(messages)

        with monkeypatch.context() as patch:
            patch.setattr(spool, "append", wait)
            try:
                yield is_asked
            finally:
                answers.set()

    return hanging


def said(seq: int) -> Journaled:
    return Journaled(seq, TEMPERATURE, 0, b"20 degC")


def mayday(seq: int) -> Journaled:
    return Journaled(seq, EVENT, 0, b"mayday")


def kept(spool: Spool) -> list[int]:
    return [entry.seq for entry in spool.read(spool.boot_id, 1, 10**6)]


def test_what_is_on_disk_is_not_written_again(spool, journal, monkeypatch):
    written: list[int] = []
    append = spool.append

    def count(messages):
        written.extend(message.seq for message in messages)
        append(messages)

    monkeypatch.setattr(spool, "append", count)
    for seq in (1, 2, 3):
        journal.write([mayday(seq)])
        assert kept(spool) == list(range(1, seq + 1))
    assert written == [1, 2, 3]
    assert journal.never_saved == 0
    assert journal.fault is None


def test_what_a_disk_refuses_is_written_when_it_has_room(spool, journal, full_disk):
    with full_disk():
        journal.write([said(1), said(2)])
        assert "the disk is full" in str(journal.fault)
        assert journal.is_working
    journal.write([said(3)])
    journal.close()
    assert kept(spool) == [1, 2, 3]
    assert journal.never_saved == 0
    assert journal.fault is None


def test_nobody_waits_for_longer_than_the_disk_takes(spool, journal, monkeypatch, full_disk):
    """What is said would be on the air a second late, all of it."""
    monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 1e6)
    journal.write([mayday(1)])
    assert kept(spool) == [1]
    with full_disk():
        journal.write([mayday(2)])
        journal.write([mayday(3)])
        assert journal.fault is not None
    assert kept(spool) == [1]


def test_a_disk_that_has_just_refused_is_not_asked_at_every_message(spool, journal, monkeypatch):
    """Thousands wait: to offer them ten times a second leaves the tracker no processor."""
    offered: list[int] = []
    append = spool.append

    def refuse(messages):
        offered.append(len(messages))
        raise StoreError("the disk is full")

    monkeypatch.setattr("edge.journal.writer._AGAIN_S", 600.0)
    monkeypatch.setattr(spool, "append", refuse)
    for seq in range(1, 6):
        journal.write([mayday(seq)])
    assert offered == [1]
    monkeypatch.setattr(spool, "append", append)
    journal.close()
    assert kept(spool) == [1, 2, 3, 4, 5]


def test_a_disk_that_has_refused_is_asked_again_though_nothing_more_is_said(
    spool, journal, monkeypatch, full_disk
):
    monkeypatch.setattr("edge.journal.writer._AGAIN_S", 0.01)
    with full_disk():
        journal.write([said(1)])
    until(lambda: kept(spool) == [1])
    until(lambda: journal.fault is None)


def test_an_alert_is_not_ousted_by_what_came_after_it(spool, journal, monkeypatch, full_disk):
    """Neither a disk nor a link for minutes: the mayday is what must not be missing."""
    monkeypatch.setattr("edge.journal.writer._UNSAVED_KEPT", 3)
    with full_disk():
        journal.write([mayday(1)])
        journal.write(map(said, range(2, 7)))
    journal.write([said(7)])
    journal.close()
    assert kept(spool) == [1, 5, 6, 7]
    assert journal.never_saved == 3


def test_what_a_full_disk_cost_is_counted_and_said(spool, journal, monkeypatch, caplog, full_disk):
    monkeypatch.setattr("edge.journal.writer._UNSAVED_KEPT", 3)
    with full_disk():
        for seq in range(1, 6):
            journal.write([mayday(seq)])
    journal.write([mayday(6)])
    journal.close()
    assert kept(spool) == [4, 5, 6]
    assert journal.never_saved == 3
    told = [record.getMessage() for record in caplog.records]
    assert told[1:] == [
        "the journal can be written again; 3 messages were sent and not kept since the start"
    ]


def test_a_disk_that_hangs_is_not_waited_for(spool, journal, monkeypatch, hanging_disk):
    monkeypatch.setattr("edge.disk_watch.HANGS_S", 0.0)
    with hanging_disk() as is_asked:
        monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 0.05)
        journal.write([said(1)])
        monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 0.0)
        is_asked.wait(PATIENCE_S)
        monkeypatch.setattr(journal._changed, "wait_for", lambda *_: pytest.fail("it waits"))
        for seq in (2, 3, 4):
            journal.write([said(seq)])
        assert "has not answered" in str(journal.fault)
        monkeypatch.undo()
    until(lambda: kept(spool) == [1, 2, 3, 4])
    until(lambda: journal.fault is None)
    assert journal.never_saved == 0


def test_what_a_disk_has_in_hand_while_it_hangs_is_kept_once_and_not_ousted(
    spool, journal, monkeypatch, hanging_disk
):
    monkeypatch.setattr("edge.journal.writer._UNSAVED_KEPT", 2)
    monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 0.01)
    with hanging_disk() as is_asked:
        journal.write([said(1), said(2)])
        is_asked.wait(PATIENCE_S)
        journal.write(map(said, range(3, 8)))
    until(lambda: kept(spool) == [1, 2, 6, 7])
    assert journal.never_saved == 3


def test_a_disk_that_is_slow_now_and_then_is_no_fault(spool, journal, monkeypatch, hanging_disk):
    monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 0.01)
    with hanging_disk():
        journal.write([said(1)])
        journal.write([said(2)])
        assert journal.fault is None


def test_the_end_does_not_wait_for_a_disk_that_hangs(spool, journal, monkeypatch, hanging_disk):
    monkeypatch.setattr("edge.disk_watch.HANGS_S", 0.3)
    monkeypatch.setattr("edge.journal.writer._PATIENCE_S", 0.01)
    with hanging_disk() as is_asked:
        journal.write([said(1)])
        is_asked.wait(PATIENCE_S)
        closing = Thread(target=journal.close)
        closing.start()
        closing.join(PATIENCE_S / 2)
        assert not closing.is_alive()
