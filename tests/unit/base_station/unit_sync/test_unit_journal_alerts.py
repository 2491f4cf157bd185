"""Alerts of a unit's journal are requested before anything else, and once."""

from __future__ import annotations

from base_station.unit_sync.journal_client import Held, JournalClient
from shared.messages import JournalBoot, JournalChunk, JournalEntry
from shared.sequence_set import Run, SequenceSet
from tests.rig.asked_journal import BOOT, answer, asked_of, indexed, journal_of, next_of


def test_alerts_are_requested_at_once_over_all_missing_numbers() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), Run(61, 70))
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 60)


def test_alert_that_may_be_in_transit_is_waited_for() -> None:
    journal = journal_of(Run(1, 70), last=100)
    assert journal.next_question() is None


def test_alerts_at_the_end_of_a_run_come_before_any_backlog() -> None:
    """A fall without a link, the unit restarts, and then the link returns."""
    ended, running = Held(BOOT, (Run(1, 70),)), Held(8, (Run(1, 5), Run(500, 510)))
    journal = JournalClient()
    journal.report((ended,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 70, 0, 0))
    journal.report((ended, running), 1)
    indexed(journal, JournalBoot(BOOT, 1, 100, 0, 0), JournalBoot(8, 1, 510, 0, 0))
    journal.report((ended, running), 2)
    asked = asked_of(journal)
    alerts = [(one["epoch"], one["from"], one["to"]) for one in asked[:2]]
    assert alerts == [(8, 6, 499), (BOOT, 71, 100)]
    assert len(asked) > 2, "and the rest behind them"


def test_alerts_are_requested_once() -> None:
    journal = journal_of(Run(1, 10), Run(61, 70), last=70)
    question = journal.next_question()
    assert question is not None
    alert = JournalEntry(20, "alert/event", b"")
    answer(journal, question, JournalChunk(BOOT, 11, 20, (alert,), urgent_only=True))
    question = journal.next_question()
    assert question is not None
    assert dict(question.parameters)["from"] == 21  # where the answer had ended
    answer(journal, question, JournalChunk(BOOT, 21, 60, (), urgent_only=True))
    journal.report((Held(BOOT, (Run(1, 10), Run(61, 70))),), 1)
    assert next_of(journal)[0] == "range"


def test_messages_fetched_as_alerts_are_not_fetched_again() -> None:
    journal = journal_of(Run(1, 18), Run(21, 21), last=21)
    question = journal.next_question()
    assert question is not None
    alert = JournalEntry(20, "alert/event", b"")
    answer(journal, question, JournalChunk(BOOT, 19, 20, (alert,), urgent_only=True))
    journal.report((Held(BOOT, (Run(1, 18), Run(21, 21))),), 1)
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("range", 19, 19)


def test_written_messages_do_not_wait_for_unwritten_ones() -> None:
    """They were sent without a link on a full disk: the journal cannot give them for now."""
    held = (Held(BOOT, (Run(1, 10), Run(91, 100))),)
    journal = journal_of(*held[0].runs, last=100)
    written, came, unanswered = 60, SequenceSet(), []

    def ask_all(now_ns: int) -> None:
        journal.report(held, now_ns)
        while (question := journal.next_question()) is not None:
            asked = dict(question.parameters)
            if question.what == "acknowledge":
                break
            last = min(asked["to"], written)
            if asked["from"] > last:
                unanswered.append(question.what)
                journal.end(question, 1)
                continue
            urgent = question.what == "urgent"
            if not urgent:
                came.add_run(Run(asked["from"], last))
            answer(journal, question, JournalChunk(BOOT, asked["from"], last, (), urgent))

    for number in range(1, 30):
        ask_all(number)
    assert list(came.runs()) == [Run(11, 60)]
    assert unanswered.count("urgent") >= 10, "whatever else there is, an alert is asked for"
    written = 100
    for number in range(30, 33):
        ask_all(number)
    assert list(came.runs()) == [Run(11, 90)]
