"""Answers of a unit's journal: which are accepted and kept, and units that give none."""

from __future__ import annotations

import pytest

from base_station.unit_sync.journal_client import Held, JournalClient, Question
from shared.errors import WireError
from shared.messages import JournalBoot, JournalChunk, JournalEntry
from shared.sequence_set import Run
from tests.rig.asked_journal import BOOT, answer, indexed, journal_of


def test_unit_without_answer_is_not_asked_before_the_next_report() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), last=30)
    question = journal.next_question()
    assert question is not None
    journal.end(question, 1)
    assert journal.next_question() is None
    journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 1)
    assert journal.next_question() == question


def test_answer_to_another_request_is_refused() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30))
    question = journal.next_question()
    assert question is not None
    entry = JournalEntry(12, "alert/event", b"")
    for chunk in (
        JournalChunk(BOOT + 1, 11, 20, ()),
        JournalChunk(BOOT, 1, 20, ()),
        JournalChunk(BOOT, 11, 2**63, ()),
        JournalChunk(BOOT, 20, 11, ()),
        JournalChunk(BOOT, 13, 20, (entry,)),
        JournalChunk(BOOT, 11, 20, (entry, entry)),
    ):
        with pytest.raises(WireError):
            journal.take(question, chunk.to_bytes(), 1)


@pytest.mark.parametrize("what", ["index", "urgent", "range"])
def test_unit_with_invalid_answers_is_not_asked_before_the_next_report(what: str) -> None:
    """Otherwise both would repeat as fast as the link carries it."""
    held = (Held(BOOT, (Run(1, 10), Run(21, 30))),)
    journal = JournalClient()
    journal.report(held, 0)
    if what != "index":
        indexed(journal, JournalBoot(BOOT, 1, 30, 0, 0))
    if what == "range":
        question = journal.next_question() or Question("none")
        answer(journal, question, JournalChunk(BOOT, 11, 20, (), urgent_only=True))
        journal.report(held, 1)
    question = journal.next_question() or Question("none")
    assert question.what == what
    with pytest.raises(WireError):
        journal.take(question, b"\xff nonsense", 2)
    journal.end(question, 1)
    assert journal.next_question() is None
    journal.report(held, 3)
    assert journal.next_question() == question


def test_only_missing_messages_of_an_answer_are_kept() -> None:
    journal = journal_of(Run(1, 10), Run(13, 14), Run(17, 30), last=30)
    held = Held(BOOT, (Run(1, 10), Run(13, 14), Run(17, 30)))
    question = journal.next_question()
    assert question is not None
    answer(journal, question, JournalChunk(BOOT, 11, 16, (), urgent_only=True))
    journal.report((held,), 1)
    question = journal.next_question()
    assert question is not None
    entries = tuple(JournalEntry(seq, "up/position", b"") for seq in range(11, 17))
    chunk = journal.take(question, JournalChunk(BOOT, 11, 16, entries).to_bytes(), 1)
    assert chunk is not None
    assert [one.seq for one in chunk.entries] == [11, 12, 15, 16]
