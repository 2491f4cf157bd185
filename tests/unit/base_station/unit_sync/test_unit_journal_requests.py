"""Missing numbers of a unit's messages, and the pieces in which its journal is asked for them."""

from __future__ import annotations

from base_station.unit_sync.adaptive_chunk_size import LEAST_BYTES
from base_station.unit_sync.journal_client import Held, JournalClient, Question
from shared.clock import NS_PER_S
from shared.messages import JournalBoot, JournalChunk, JournalEntry
from shared.sequence_set import Run, SequenceSet
from tests.rig.asked_journal import (
    BOOT,
    answer,
    asked_in_turn,
    asked_of,
    indexed,
    journal_of,
    next_of,
)


def test_gap_is_found_by_a_later_message() -> None:
    journal = journal_of(Run(1, 100), last=100)
    for number in range(2):
        journal.report((Held(BOOT, (Run(1, 100), Run(151, 160))),), number)
    first, *_ = asked_of(journal)
    assert (first["from"], first["to"]) == (101, 150)


def test_messages_deleted_from_the_journal_are_not_requested() -> None:
    journal = JournalClient()
    held = (Held(BOOT, (Run(90, 100),)),)
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 51, 100, 0, 0))
    journal.report(held, 1)
    asked = asked_of(journal)
    assert min(one["from"] for one in asked) == 51
    assert max(one["to"] for one in asked) == 89


def test_unit_that_fell_silent_gets_small_requests_again() -> None:
    held = (Held(BOOT, (Run(1, 1),)),)
    journal = journal_of(Run(1, 1), last=100_000)
    totals = []
    for number in range(6):
        journal.report(held, number)
        question = journal.next_question()
        assert question is not None
        asked = dict(question.parameters)
        if question.what == "urgent":
            last = JournalChunk(BOOT, asked["from"], asked["to"], (), urgent_only=True)
            answer(journal, question, last)
            continue
        totals.append(asked["total"])
        assert asked["bytes"] == min(asked["total"], 8192), "what comes first is stored first"
        if number < 5:
            entry = JournalEntry(asked["to"], "up/position", bytes(asked["total"]))
            answer(journal, question, JournalChunk(BOOT, asked["to"], asked["to"], (entry,)))
        else:
            journal.end(question, 1)
    journal.report(held, 7)
    assert totals == sorted(totals)
    assert totals[-1] > 8192
    assert next_of(journal)[1]["total"] == totals[0]


def after_single_losses(last: int) -> JournalClient:
    """Many single losses, each fetched at once; then an outage until ``last``."""
    held = SequenceSet([1], [200])
    for lost in range(10, 200, 10):
        held.discard(lost)
    journal = journal_of(*held.runs(), last=200)
    for number in range(4):
        journal.report((Held(BOOT, tuple(held.runs())),), number)
        while (question := journal.next_question()) is not None:
            if question.what == "acknowledge":
                break
            asked = dict(question.parameters)
            seqs = [] if question.what == "urgent" else range(asked["from"], asked["to"] + 1)
            entries = tuple(JournalEntry(seq, "up/position", bytes(80)) for seq in seqs)
            chunk = JournalChunk(
                BOOT, asked["from"], asked["to"], entries, urgent_only=question.what == "urgent"
            )
            answer(journal, question, chunk)
    for number in range(4, 6):
        held.add(last)
        journal.report((Held(BOOT, (Run(1, 200), Run(last, last))),), number)
    return journal


def test_first_request_of_a_long_outage_is_small_after_many_single_losses() -> None:
    """One quick message does not show that a thin link carries half a megabyte."""
    journal = after_single_losses(5000)
    question = journal.next_question() or Question("none")
    answer(journal, question, JournalChunk(BOOT, 201, 4999, (), urgent_only=True))
    what, asked = next_of(journal)
    assert (what, asked["to"], asked["total"]) == ("range", 4999, LEAST_BYTES)


def test_many_missing_numbers_are_asked_about_in_few_requests() -> None:
    held = Held(BOOT, (Run(1, 1), Run(200_001, 200_001)))
    journal = journal_of(*held.runs, last=200_001)
    journal.report((held,), 1)
    assert len(asked_in_turn(journal, held, 100)) < 50


def test_newest_piece_is_requested_first() -> None:
    journal = journal_of(Run(1, 1), last=1000)
    journal.report((Held(BOOT, (Run(1, 1),)),), 1)
    question = journal.next_question()
    assert question is not None
    answer(journal, question, JournalChunk(BOOT, 2, 1000, (), urgent_only=True))
    what, asked = next_of(journal)
    assert (what, asked["to"]) == ("range", 1000)
    assert 1 < asked["from"] < 1000


def test_first_message_of_a_run_may_be_in_transit_like_any_other() -> None:
    held = (Held(BOOT, (Run(2, 2),)),)
    journal = journal_of(Run(2, 2), last=2)
    question = journal.next_question() or Question("none")
    answer(journal, question, JournalChunk(BOOT, 1, 1, (), urgent_only=True))
    assert journal.next_question() is None
    journal.report(held, 1)
    assert next_of(journal)[0] == "range"


def test_number_of_requested_messages_follows_from_their_size() -> None:
    def numbers_of_a_piece(payload: bytes) -> int:
        held = Held(BOOT, (Run(1, 1),))
        journal = journal_of(Run(1, 1), last=100_000)
        journal.report((held,), 1)
        for _ in range(60):
            what, asked = next_of(journal)
            entry = JournalEntry(asked["to"], "up/position", payload)
            first = asked["from"] if what == "urgent" else asked["to"]
            entries = () if what == "urgent" else (entry,)
            chunk = JournalChunk(BOOT, first, asked["to"], entries, urgent_only=what == "urgent")
            question = journal.next_question()
            assert question is not None
            journal.take(question, chunk.to_bytes(), 1)
            journal.end(question, NS_PER_S // 2)  # exactly the wanted length
        return asked["to"] - asked["from"] + 1

    small, large = numbers_of_a_piece(bytes(20)), numbers_of_a_piece(bytes(500))
    assert small > 10
    assert large < small / 3


def test_gaps_behind_the_journals_index_are_filled() -> None:
    journal = journal_of(Run(1, 100), last=100)
    held = Held(BOOT, (Run(1, 100), Run(151, 160)))
    journal.report((held,), 1)
    pieces = asked_in_turn(journal, held, 20)
    assert (pieces[-1][0], pieces[0][1]) == (101, 150)


def test_many_small_gaps_are_asked_about_together() -> None:
    """A journal that dropped its least valuable messages has them: after a restart of the station
    they are all missing again.
    """
    held = Held(BOOT, tuple(Run(5 * n + 1, 5 * n + 3) for n in range(10_000)))
    journal = JournalClient()
    journal.report((held,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 49_998, 0, 0))
    pieces = asked_in_turn(journal, held, 100)
    assert len(pieces) < 50
    missing = SequenceSet()
    for first, last in pieces:
        missing.add_run(Run(first, last))
    assert all(number in missing for number in range(4, 49_998, 5))


def test_messages_between_two_gaps_are_fetched_again_only_if_they_are_few() -> None:
    held = Held(BOOT, (Run(1, 10), Run(13, 40), Run(43, 46), Run(49, 60)))
    journal = JournalClient()
    journal.report((held,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 60, 0, 0))
    assert asked_in_turn(journal, held, 20) == [(41, 48), (11, 12)]
