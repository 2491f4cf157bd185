"""Index requests: which runs of a unit's program its journal is asked about, and when."""

from __future__ import annotations

from base_station.core.state.message_stream import BOOTS_KEPT
from base_station.unit_sync.journal_client import Held, JournalClient, Question
from shared.clock import NS_PER_S
from shared.messages import JournalBoot, JournalChunk, JournalIndex
from shared.sequence_set import Run
from tests.rig.asked_journal import BOOT, answer, asked_of, indexed, journal_of, next_of


def test_restarted_unit_is_asked_at_once() -> None:
    journal = journal_of(Run(1, 100))
    journal.report((Held(BOOT, (Run(1, 100),)), Held(8, (Run(5, 5),))), 1)
    assert next_of(journal)[0] == "index"


def test_index_is_requested_now_and_then() -> None:
    journal = journal_of(Run(1, 100))
    held = (Held(BOOT, (Run(1, 100),)),)
    journal.report(held, 29 * NS_PER_S)
    assert journal.next_question() is None
    journal.report(held, 31 * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_run_without_journal_content_causes_no_further_requests() -> None:
    """An index of many runs once a second takes a good part of a thin link, for ever."""
    journal = JournalClient()
    held = (Held(3, (Run(1, 10),)), Held(BOOT, (Run(1, 10),)))
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 1, 10, 0, 0))
    journal.report(held, 1 * NS_PER_S)
    assert journal.next_question() is None
    journal.report(held, 31 * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_run_not_on_the_units_disk_yet_is_requested_again_and_again() -> None:
    journal = JournalClient()
    held = (Held(3, (Run(1, 10),)), Held(BOOT, (Run(1, 10),)))
    journal.report(held, 0)
    for number in range(1, 4):
        indexed(journal, JournalBoot(3, 1, 10, 0, 0))
        journal.report(held, number * NS_PER_S)
    assert next_of(journal)[0] == "index"


def test_run_deleted_from_the_journal_is_not_requested() -> None:
    journal = JournalClient()
    for first, due_ns in ((1, 0), (2, 3600 * 10**9)):
        journal.report((Held(3, (Run(1, 10),)),), due_ns)
        indexed(journal, *[JournalBoot(boot_id, 1, 10, 0, 0) for boot_id in range(first, 4)])
    journal.report((Held(3, (Run(1, 10),)),), 0)
    assert {question["epoch"] for question in asked_of(journal)} == {2}


def test_both_journals_of_two_machines_under_one_name_are_known() -> None:
    journal = JournalClient()
    held = Held(BOOT, (Run(1, 10),)), Held(8, (Run(1, 4), Run(7, 8)))
    journal.report(held, 0)
    question = journal.next_question()
    assert question is not None
    for boot_id, last in ((8, 8), (BOOT, 10)):
        journal.take(question, JournalIndex((JournalBoot(boot_id, 1, last, 0, 0),)).to_bytes(), 1)
    journal.end(question, 1)
    what, asked = next_of(journal)
    assert (what, asked["epoch"], asked["from"], asked["to"]) == ("urgent", 8, 5, 6)


def test_newest_of_any_number_of_runs_are_requested() -> None:
    journal = JournalClient()
    journal.report((Held(BOOTS_KEPT + 5, (Run(1, 3),)),), 0)
    indexed(journal, *(JournalBoot(number, 1, 3, 0, 0) for number in range(1, BOOTS_KEPT + 6)))
    assert len(journal._boots) <= BOOTS_KEPT
    journal.report((Held(BOOTS_KEPT + 5, (Run(1, 3),)),), 1)
    asked = []
    for _ in range(5):
        question = journal.next_question()
        assert question is not None
        epoch = dict(question.parameters)["epoch"]
        asked.append(epoch)
        answer(journal, question, JournalChunk(epoch, 1, 3, (), urgent_only=True))
    assert asked == [BOOTS_KEPT + 4 - number for number in range(5)]


MANY = 300


def index_named(journal: JournalClient, took_ns: int) -> int:
    """Number of runs requested of a unit that has started ``MANY`` times, and answers so."""
    question = journal.next_question()
    assert question is not None
    assert question.what == "index"
    asked = dict(question.parameters)["newest"]
    named = range(max(1, MANY - asked + 1), MANY + 1)
    boots = tuple(JournalBoot(number, 1, 3, 0, 1_700_000_000_000_000_000) for number in named)
    journal.take(question, JournalIndex(boots).to_bytes(), 1)
    journal.end(question, took_ns)
    return asked


def fetched(journal: JournalClient) -> list[int]:
    """Runs of which everything is fetched, in order."""
    return list(dict.fromkeys(question["epoch"] for question in asked_of(journal)))


def test_index_of_a_unit_with_many_starts_grows_as_the_link_carries_it() -> None:
    """An index of thousands of runs blocks a thin link, and alerts wait behind it."""
    journal, held = JournalClient(), (Held(MANY, (Run(1, 3),)),)
    asked, epochs = [], []
    for second in range(5):
        journal.report(held, second * NS_PER_S)
        asked.append(index_named(journal, NS_PER_S // 100))
        journal.report(held, second * NS_PER_S)  # missing messages have had the time to come
        epochs += fetched(journal)
    assert asked == [32, 64, 128, 256, 512]
    assert epochs == list(range(MANY - 1, 0, -1)), "the newest first, each once"
    journal.report(held, 29 * NS_PER_S)
    assert next_of(journal)[0] == "acknowledge", "that is all of them"


def test_thin_link_gets_few_index_requests_and_known_runs_stay_known() -> None:
    journal, held = JournalClient(), (Held(MANY, (Run(1, 3),)),)
    journal.report(held, 0)
    asked = [index_named(journal, NS_PER_S // 100)]
    for number in range(1, 5):
        journal.report(held, 31 * number * NS_PER_S)
        asked.append(index_named(journal, 4 * NS_PER_S))
    assert asked == [32, 64, 32, 32, 32]
    journal.report(held, 200 * NS_PER_S)
    journal.end(Question("index", (("newest", 32),)), 1)
    journal.report(held, 201 * NS_PER_S)
    journal.note_new_link()
    index_named(journal, 4 * NS_PER_S)
    assert fetched(journal) == list(range(MANY - 1, MANY - 64, -1))
