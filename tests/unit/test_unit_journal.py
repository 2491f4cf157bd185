"""What a unit's journal is asked next follows from what the station has."""

from __future__ import annotations

import pytest

from base_station.journals.unit_journal import Held, Question, UnitJournal
from base_station.sender import BOOTS
from shared.clock import NS_PER_S
from shared.errors import WireError
from shared.messages import JournalBoot, JournalChunk, JournalEntry, JournalIndex
from shared.sequence_set import Run, SequenceSet

BOOT = 7


def indexed(journal: UnitJournal, *boots: JournalBoot) -> None:
    question = journal.next_question()
    assert question is not None
    assert question.what == "index"
    journal.take(question, JournalIndex(boots).to_bytes(), 1)
    journal.end(question, 1)


def journal_of(*runs: Run, last: int = 100) -> UnitJournal:
    journal = UnitJournal()
    journal.report((Held(BOOT, runs),), 0)
    indexed(journal, JournalBoot(BOOT, 1, last, 0, 0))
    return journal


def answer(journal: UnitJournal, question: Question, chunk: JournalChunk) -> None:
    journal.take(question, chunk.to_bytes(), 1)
    journal.end(question, 1)


def next_of(journal: UnitJournal) -> tuple[str, dict[str, int]]:
    question = journal.next_question()
    assert question is not None
    return question.what, dict(question.parameters)


def asked_of(journal: UnitJournal) -> list[dict[str, int]]:
    """Everything that is asked for where nothing is left any more."""
    asked: list[dict[str, int]] = []
    while (question := journal.next_question()) is not None and question.what != "acknowledge":
        asked.append(dict(question.parameters))
        first, last = asked[-1]["from"], asked[-1]["to"]
        boot_id, urgent = asked[-1]["epoch"], question.what == "urgent"
        answer(journal, question, JournalChunk(boot_id, first, last, (), urgent_only=urgent))
    return asked


def test_alerts_are_asked_for_at_once_over_the_whole_of_what_is_missing() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), Run(61, 70))
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 60)


def test_an_alert_that_may_still_be_under_way_is_waited_for() -> None:
    journal = journal_of(Run(1, 70), last=100)
    assert journal.next_question() is None


def test_the_alerts_among_the_last_words_of_a_run_come_before_any_backlog() -> None:
    """A fall in the dark, the unit starts again, and then the link returns."""
    ended, running = Held(BOOT, (Run(1, 70),)), Held(8, (Run(1, 5), Run(500, 510)))
    journal = UnitJournal()
    journal.report((ended,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 70, 0, 0))
    journal.report((ended, running), 1)
    indexed(journal, JournalBoot(BOOT, 1, 100, 0, 0), JournalBoot(8, 1, 510, 0, 0))
    journal.report((ended, running), 2)
    asked = asked_of(journal)
    alerts = [(one["epoch"], one["from"], one["to"]) for one in asked[:2]]
    assert alerts == [(8, 6, 499), (BOOT, 71, 100)]
    assert len(asked) > 2, "and the rest behind them"


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


def test_a_hole_is_found_by_what_came_behind_it() -> None:
    journal = journal_of(Run(1, 100), last=100)
    for number in range(2):
        journal.report((Held(BOOT, (Run(1, 100), Run(151, 160))),), number)
    first, *_ = asked_of(journal)
    assert (first["from"], first["to"]) == (101, 150)


def test_what_the_journal_has_no_more_is_not_asked_for() -> None:
    journal = UnitJournal()
    held = (Held(BOOT, (Run(90, 100),)),)
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 51, 100, 0, 0))
    journal.report(held, 1)
    asked = asked_of(journal)
    assert min(one["from"] for one in asked) == 51
    assert max(one["to"] for one in asked) == 89


def test_a_unit_that_fell_silent_is_asked_for_little_again() -> None:
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
            answer(journal, question, JournalChunk(BOOT, asked["to"], asked["to"], ()))
        else:
            journal.end(question, 1)
    journal.report(held, 7)
    assert totals == sorted(totals)
    assert totals[-1] > 8192
    assert next_of(journal)[1]["total"] == totals[0]


def test_alerts_are_asked_for_once() -> None:
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


def test_what_the_alerts_brought_is_not_fetched_again() -> None:
    journal = journal_of(Run(1, 18), Run(21, 21), last=21)
    question = journal.next_question()
    assert question is not None
    alert = JournalEntry(20, "alert/event", b"")
    answer(journal, question, JournalChunk(BOOT, 19, 20, (alert,), urgent_only=True))
    journal.report((Held(BOOT, (Run(1, 18), Run(21, 21))),), 1)
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("range", 19, 19)


def test_who_does_not_answer_is_not_asked_before_the_next_report() -> None:
    journal = journal_of(Run(1, 10), Run(21, 30), last=30)
    question = journal.next_question()
    assert question is not None
    journal.end(question, 1)
    assert journal.next_question() is None
    journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 1)
    assert journal.next_question() == question


def test_a_run_that_the_journal_has_no_more_is_not_asked_for() -> None:
    journal = UnitJournal()
    for first, due_ns in ((1, 0), (2, 3600 * 10**9)):
        journal.report((Held(3, (Run(1, 10),)),), due_ns)
        indexed(journal, *[JournalBoot(boot_id, 1, 10, 0, 0) for boot_id in range(first, 4)])
    journal.report((Held(3, (Run(1, 10),)),), 0)
    assert {question["epoch"] for question in asked_of(journal)} == {2}


def test_the_newest_piece_is_asked_for_first() -> None:
    journal = journal_of(Run(1, 1), last=1000)
    journal.report((Held(BOOT, (Run(1, 1),)),), 1)
    question = journal.next_question()
    assert question is not None
    answer(journal, question, JournalChunk(BOOT, 2, 1000, (), urgent_only=True))
    what, asked = next_of(journal)
    assert (what, asked["to"]) == ("range", 1000)
    assert 1 < asked["from"] < 1000


@pytest.mark.parametrize("reports", [1, 2, 3])
def test_what_is_complete_is_acknowledged_when_it_is_on_the_disk(reports: int) -> None:
    journal = journal_of(Run(1, 100))
    for number in range(1, reports):
        journal.report((Held(BOOT, (Run(1, 100 + number),)),), number)
    question = journal.next_question()
    if reports < 3:
        assert question is None
        return
    assert question is not None
    assert question == Question("acknowledge", (("epoch", BOOT), ("to", 100)), urgent=False)
    index = JournalIndex((JournalBoot(BOOT, 1, 101, 100, 0),)).to_bytes()
    journal.take(question, index, 1)
    journal.end(question, 1)
    assert journal.next_question() is None


def test_a_run_of_a_single_message_is_acknowledged_too() -> None:
    journal = journal_of(Run(1, 1), last=1)
    for number in range(1, 3):
        journal.report((Held(BOOT, (Run(1, 1),)),), number)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 1})


def test_the_first_message_of_a_run_may_be_under_way_like_any_other() -> None:
    held = (Held(BOOT, (Run(2, 2),)),)
    journal = journal_of(Run(2, 2), last=2)
    question = journal.next_question() or Question("none")
    answer(journal, question, JournalChunk(BOOT, 1, 1, (), urgent_only=True))
    assert journal.next_question() is None
    journal.report(held, 1)
    assert next_of(journal)[0] == "range"


def test_a_journal_that_gave_up_its_beginning_may_still_forget_what_is_safe() -> None:
    """Or it would give up what nobody has, for what the station has had for long."""
    journal = UnitJournal()
    held = (Held(BOOT, (Run(51, 100),)),)
    journal.report(held, 0)
    indexed(journal, JournalBoot(BOOT, 51, 100, 0, 0))
    for number in range(1, 4):
        assert journal.next_question() is None
        journal.report(held, number)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 100})


def test_numbers_that_nobody_has_are_counted_and_count_as_complete() -> None:
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
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 8})


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


def test_what_was_fetched_and_did_not_come_into_the_log_is_asked_for_again() -> None:
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
    assert next_of(journal)[0] == "acknowledge"  # nobody has them
    journal.start_over()
    journal.report((Held(BOOT, (Run(1, 10), Run(21, 30))),), 3)
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 20)


def test_nothing_is_told_to_be_safe_before_it_is_reported_anew() -> None:
    journal = journal_of(Run(1, 10), last=20)
    held = (Held(BOOT, (Run(1, 10),)),)
    asked_in_turn(journal, held[0], 20)
    assert next_of(journal) == ("acknowledge", {"epoch": BOOT, "to": 20})
    journal.start_over()
    what, asked = next_of(journal)
    assert (what, asked["from"], asked["to"]) == ("urgent", 11, 20)
    asked_of(journal)
    assert journal.next_question() is None  # the log may have refused these, too


def test_how_much_is_asked_for_follows_from_how_large_messages_are() -> None:
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
            journal.end(question, NS_PER_S // 2)  # as long as is wanted: no more, no less
        return asked["to"] - asked["from"] + 1

    small, large = numbers_of_a_piece(bytes(20)), numbers_of_a_piece(bytes(500))
    assert small > 10
    assert large < small / 3


def test_what_came_behind_all_that_the_journal_told_of_has_its_holes_filled() -> None:
    journal = journal_of(Run(1, 100), last=100)
    held = Held(BOOT, (Run(1, 100), Run(151, 160)))
    journal.report((held,), 1)
    pieces = asked_in_turn(journal, held, 20)
    assert (pieces[-1][0], pieces[0][1]) == (101, 150)


def test_an_answer_to_another_question_is_not_believed() -> None:
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
def test_who_answers_nonsense_is_not_asked_before_the_next_report(what: str) -> None:
    """Or the two would go on as fast as the link carries it."""
    held = (Held(BOOT, (Run(1, 10), Run(21, 30))),)
    journal = UnitJournal()
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


def asked_in_turn(journal: UnitJournal, held: Held, most: int) -> list[tuple[int, int]]:
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


def test_many_small_holes_are_asked_about_together() -> None:
    """As a journal has them that gave up what was of least worth: after a restart of the station
    they are all missing again.
    """
    held = Held(BOOT, tuple(Run(5 * n + 1, 5 * n + 3) for n in range(10_000)))
    journal = UnitJournal()
    journal.report((held,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 49_998, 0, 0))
    pieces = asked_in_turn(journal, held, 100)
    assert len(pieces) < 50
    missing = SequenceSet()
    for first, last in pieces:
        missing.add_run(Run(first, last))
    assert all(number in missing for number in range(4, 49_998, 5))


def test_what_is_there_between_two_holes_is_not_asked_for_again_unless_it_is_little() -> None:
    held = Held(BOOT, (Run(1, 10), Run(13, 40), Run(43, 46), Run(49, 60)))
    journal = UnitJournal()
    journal.report((held,), 0)
    indexed(journal, JournalBoot(BOOT, 1, 60, 0, 0))
    assert asked_in_turn(journal, held, 20) == [(41, 48), (11, 12)]


def test_of_an_answer_only_what_is_missing_is_kept() -> None:
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


def test_what_a_unit_wrote_does_not_wait_for_what_its_disk_does_not_take() -> None:
    """It was said in the dark on a disk that is full: the journal cannot give it for now."""
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
