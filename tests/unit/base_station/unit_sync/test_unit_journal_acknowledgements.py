"""Acknowledgements to a unit's journal of messages that it may delete, and repeated requests."""

from __future__ import annotations

import pytest

from base_station.unit_sync.journal_client import Held, JournalClient, Question
from shared.clock import NS_PER_S
from shared.messages import JournalBoot, JournalChunk, JournalEntry, JournalIndex
from shared.sequence_set import Run
from tests.rig.asked_journal import (
    BOOT,
    answer,
    asked_in_turn,
    asked_of,
    indexed,
    journal_of,
    next_of,
)


@pytest.mark.parametrize("reports", [1, 2, 3])
def test_complete_run_is_acknowledged_when_it_is_on_the_disk(reports: int) -> None:
    journal = journal_of(Run(1, 100))
    for number in range(1, reports):
        journal.report((Held(BOOT, (Run(1, 100 + number),)),), number)
    question = journal.next_question()
    if reports < 3:
        assert question is None
        return
    assert question is not None
    reported = (("epoch", BOOT), ("to", 100), ("newest", 0))
    assert question == Question("acknowledge", reported, urgent=False)
    index = JournalIndex((JournalBoot(BOOT, 1, 101, 100, 0),)).to_bytes()
    journal.take(question, index, 1)
    journal.end(question, 1)
    assert journal.next_question() is None


def test_current_run_is_acknowledged_now_and_then() -> None:
    """Each answer names all runs of the journal: every second that is much for a thin link."""
    journal, last = JournalClient(), 100
    journal.report((Held(BOOT, (Run(1, last),)),), 0)
    indexed(journal, JournalBoot(BOOT, 1, last, 0, 0))
    acknowledged = []
    for second in range(1, 30):
        last += 8
        journal.report((Held(BOOT, (Run(1, last),)),), second * NS_PER_S)
        question = journal.next_question()
        if question is not None:
            assert question.what == "acknowledge"
            acknowledged.append(second)
            index = JournalIndex((JournalBoot(BOOT, 1, last, 0, 0),)).to_bytes()
            journal.take(question, index, second * NS_PER_S)
            journal.end(question, 1)
    assert acknowledged == [2, 12, 22]


def test_ended_runs_are_each_acknowledged_at_once() -> None:
    held = tuple(Held(number, (Run(1, 10),)) for number in range(1, 6))
    journal = JournalClient()
    journal.report(held, 0)
    boots = [JournalBoot(number, 1, 10, 0, 0) for number in range(1, 6)]
    indexed(journal, *boots)
    for second in range(1, 3):
        journal.report(held, second)
    acknowledged = []
    while (question := journal.next_question()) is not None:
        acknowledged.append(dict(question.parameters)["epoch"])
        journal.take(question, JournalIndex(tuple(boots)).to_bytes(), 3)
        journal.end(question, 1)
    assert acknowledged == [5, 4, 3, 2, 1]


def test_run_of_a_single_message_is_acknowledged_too() -> None:
    journal = journal_of(Run(1, 1), last=1)
    for number in range(1, 3):
        journal.report((Held(BOOT, (Run(1, 1),)),), number)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 1, "newest": 0})


def test_journal_that_dropped_its_beginning_may_still_delete_safe_messages() -> None:
    """Otherwise it would drop messages that nobody has, and keep those of the station."""
    journal = JournalClient()
    held = (Held(BOOT, (Run(51, 100),)),)
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 51, 100, 0, 0))
    for number in range(1, 4):
        assert journal.next_question() is None
        journal.report(held, number)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 100, "newest": 0})


def test_lost_numbers_are_counted_and_count_as_complete() -> None:
    journal = journal_of(Run(1, 4), Run(8, 8), last=8)
    question = journal.next_question()
    assert question is not None
    answer(journal, question, JournalChunk(BOOT, 5, 7, (), urgent_only=True))
    for number in range(2):
        journal.report((Held(BOOT, (Run(1, 4), Run(8, 8))),), number)
        question = journal.next_question()
        assert question is not None
        if question.what == "range":
            answer(journal, question, JournalChunk(BOOT, 5, 7, ()))
    assert journal.gone == 3
    for number in (3, 4):
        journal.report((Held(BOOT, (Run(1, 4), Run(8, 8))),), number)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 8, "newest": 0})


def test_fetched_message_is_safe_once_it_is_reported_and_no_sooner() -> None:
    """It may wait a while to be written."""
    journal, before = journal_of(Run(1, 10), last=12), (Held(BOOT, (Run(1, 10),)),)
    entries = tuple(JournalEntry(number, "up/position", b"") for number in (11, 12))
    for number in range(1, 7):
        question = journal.next_question()
        if question is not None and question.what == "urgent":
            answer(journal, question, JournalChunk(BOOT, 11, 12, (), urgent_only=True))
        elif question is not None and question.what == "range":
            answer(journal, question, JournalChunk(BOOT, 11, 12, entries))
        elif question is not None:
            assert dict(question.parameters)["to"] == 10
        journal.report(before, number)
    for number in range(7, 10):
        journal.report((Held(BOOT, (Run(1, 12),)),), number * NS_PER_S)
    journal.report((Held(BOOT, (Run(1, 12),)),), 20 * NS_PER_S)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 12, "newest": 0})


def test_fetched_message_missing_in_the_log_is_requested_again() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), last=30)
    for what in ("urgent", "range", "range"):
        journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 1)
        question = journal.next_question() or Question("none")
        assert question.what == what
        asked = dict(question.parameters)
        chunk = JournalChunk(BOOT, asked["from"], asked["to"], (), urgent_only=what == "urgent")
        answer(journal, question, chunk)
    for _ in range(5):
        journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 2)
    assert next_of(journal)[0] == "acknowledge"  # lost everywhere
    journal.start_over()
    journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 3)
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 20)


def test_no_message_is_safe_before_a_new_report() -> None:
    journal = journal_of(Run(1, 10), last=20)
    held = (Held(BOOT, (Run(1, 10),)),)
    asked_in_turn(journal, held[0], 20)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 20, "newest": 0})
    journal.start_over()
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 20)
    asked_of(journal)
    assert journal.next_question() is None  # the log may have refused these, too


def test_full_disk_fetches_only_alerts_and_acknowledges_nothing() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), last=30)
    held = (Held(BOOT, (Run(1, 10), Run(21, 30))),)
    for number in range(5):
        journal.report(held, number, alerts_only=True)
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 20)
    journal.end(journal.next_question() or Question("none"), 1)
    assert journal.next_question() is None, "the unit said nothing: not before the next report"
    journal.report(held, 6, alerts_only=True)
    question = journal.next_question()
    assert question is not None
    answer(journal, question, JournalChunk(BOOT, 11, 20, (), urgent_only=True))
    for number in range(7, 12):
        assert journal.next_question() is None
        journal.report(held, number, alerts_only=True)
    journal.report(held, 12)
    assert next_of(journal)[0] == "range"


def test_report_of_messages_in_memory_alone_does_not_count() -> None:
    journal = journal_of(Run(1, 100))
    held = (Held(BOOT, (Run(1, 100),)),)
    for number in range(1, 5):
        journal.report(held, number, alerts_only=True)
        assert journal.next_question() is None
    journal.report(held, 6)
    assert journal.next_question() is None
    journal.report(held, 7)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 100, "newest": 0})
    journal.report(held, 8, alerts_only=True)
    assert journal.next_question() is None
