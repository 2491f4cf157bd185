"""Which runs of a unit's program its journal is asked about, and when it is asked what it has."""

from __future__ import annotations

from base_station.journals.unit_journal import Held, UnitJournal
from base_station.units.sender import BOOTS
from shared.clock import NS_PER_S
from shared.messages import JournalBoot, JournalChunk, JournalIndex
from shared.sequence_set import Run
from tests.asked_journal import BOOT, answer, asked_of, indexed, journal_of, next_of


def test_a_unit_that_has_started_again_is_asked_at_once_what_it_has() -> None:
    journal = journal_of(Run(1, 100))
    journal.report((Held(BOOT, (Run(1, 100),)), Held(8, (Run(5, 5),))), 1)
    assert next_of(journal)[0] == "index"


def test_what_it_has_is_asked_now_and_then() -> None:
    journal = journal_of(Run(1, 100))
    held = (Held(BOOT, (Run(1, 100),)),)
    journal.report(held, 29 * NS_PER_S)
    assert journal.next_question() is None
    journal.report(held, 31 * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_a_run_of_which_the_journal_has_nothing_left_has_it_asked_no_more_often() -> None:
    """What is said of many runs once a second takes a good part of a thin link, for ever."""
    journal = UnitJournal()
    held = (Held(3, (Run(1, 10),)), Held(BOOT, (Run(1, 10),)))
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 1, 10, 0, 0))
    journal.report(held, 1 * NS_PER_S)
    assert journal.next_question() is None
    journal.report(held, 31 * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_a_run_that_is_not_on_the_units_disk_yet_is_asked_for_again_and_again() -> None:
    journal = UnitJournal()
    held = (Held(3, (Run(1, 10),)), Held(BOOT, (Run(1, 10),)))
    journal.report(held, 0)
    for number in range(1, 4):
        indexed(journal, JournalBoot(3, 1, 10, 0, 0))
        journal.report(held, number * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_a_run_that_the_journal_has_no_more_is_not_asked_for() -> None:
    journal = UnitJournal()
    for first, due_ns in ((1, 0), (2, 3600 * 10**9)):
        journal.report((Held(3, (Run(1, 10),)),), due_ns)
        indexed(journal, *[JournalBoot(boot_id, 1, 10, 0, 0) for boot_id in range(first, 4)])
    journal.report((Held(3, (Run(1, 10),)),), 0)
    assert {question["epoch"] for question in asked_of(journal)} == {2}


def test_of_two_machines_under_one_name_both_journals_are_known() -> None:
    journal = UnitJournal()
    held = Held(BOOT, (Run(1, 10),)), Held(8, (Run(1, 4), Run(7, 8)))
    journal.report(held, 0)
    question = journal.next_question()
    assert question is not None
    for boot_id, last in ((8, 8), (BOOT, 10)):
        journal.take(question, JournalIndex((JournalBoot(boot_id, 1, last, 0, 0),)).to_bytes(), 1)
    journal.end(question, 1)
    what, asked = next_of(journal)
    assert (what, asked["epoch"], asked["from"], asked["to"]) == ("urgent", 8, 5, 6)


def test_of_any_number_of_runs_the_newest_are_asked_for() -> None:
    journal = UnitJournal()
    journal.report((Held(BOOTS + 5, (Run(1, 3),)),), 0)
    indexed(journal, *(JournalBoot(number, 1, 3, 0, 0) for number in range(1, BOOTS + 6)))
    assert len(journal._boots) <= BOOTS
    journal.report((Held(BOOTS + 5, (Run(1, 3),)),), 1)
    asked = []
    for _ in range(5):
        question = journal.next_question()
        assert question is not None
        epoch = dict(question.parameters)["epoch"]
        asked.append(epoch)
        answer(journal, question, JournalChunk(epoch, 1, 3, (), urgent_only=True))
    assert asked == [BOOTS + 4 - number for number in range(5)]
