"""A unit's journal as the station asks it: reports and answers in, questions out."""

from __future__ import annotations

from base_station.unit_sync.journal_client import Held, JournalClient, Question
from shared.messages import JournalBoot, JournalChunk, JournalIndex
from shared.sequence_set import Run

BOOT = 7


def indexed(journal: JournalClient, *boots: JournalBoot) -> None:
    question = journal.next_question()
    assert question is not None
    assert question.what == "index"
    journal.take(question, JournalIndex(boots).to_bytes(), 1)
    journal.end(question, 1)


def journal_of(*runs: Run, last: int = 100) -> JournalClient:
    journal = JournalClient()
    journal.report((Held(BOOT, runs),), 0)
    indexed(journal, JournalBoot(BOOT, 1, last, 0, 0))
    return journal


def answer(journal: JournalClient, question: Question, chunk: JournalChunk) -> None:
    journal.take(question, chunk.to_bytes(), 1)
    journal.end(question, 1)


def next_of(journal: JournalClient) -> tuple[str, dict[str, int]]:
    question = journal.next_question()
    assert question is not None
    return question.what, dict(question.parameters)


def asked_of(journal: JournalClient) -> list[dict[str, int]]:
    """Everything that is asked for where nothing is left any more."""
    asked: list[dict[str, int]] = []
    while (question := journal.next_question()) is not None and question.what != "acknowledge":
        asked.append(dict(question.parameters))
        first, last = asked[-1]["from"], asked[-1]["to"]
        boot_id, urgent = asked[-1]["epoch"], question.what == "urgent"
        answer(journal, question, JournalChunk(boot_id, first, last, (), urgent_only=urgent))
    return asked


def asked_in_turn(journal: JournalClient, held: Held, most: int) -> list[tuple[int, int]]:
    """The pieces that are asked for until nothing is missing; nobody has any of them."""
    pieces: list[tuple[int, int]] = []
    for number in range(most):
        question = journal.next_question()
        if question is None or question.what == "acknowledge":
            journal.report((held,), number)
            continue
        asked = dict(question.parameters)
        if question.what == "range":
            pieces.append((asked["from"], asked["to"]))
        chunk = JournalChunk(
            BOOT, asked["from"], asked["to"], (), urgent_only=question.what == "urgent"
        )
        answer(journal, question, chunk)
    return pieces
