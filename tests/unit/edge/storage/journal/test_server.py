"""The journal's answers account for every requested number."""

from __future__ import annotations

import itertools
import logging
from contextlib import closing

import pytest

from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import EVENT, IMU, POSITION
from shared.errors import StoreError
from shared.messages import JournalChunk, JournalIndex
from tests.rig.damaged_journal import spoil_page

SOME_LEAF = (
    "SELECT pageno FROM dbstat WHERE name = 'message' AND pagetype = 'leaf' ORDER BY path "
    "LIMIT 1 OFFSET 20"
)


@pytest.fixture
def journal(tmp_path):
    journal = Journal(tmp_path / "journal.sqlite", itertools.count(9).__next__, 123, 10**8)
    journal.append([JournalRow(seq, POSITION, 0, bytes(100)) for seq in range(1, 101) if seq != 50])
    yield journal
    journal.close()


def ask(journal: Journal, what: str, parameters: str = "") -> list[bytes]:
    return list(
        JournalServer("u1", journal).replies(f"muster/v1/u1/journal/{what}", parameters, b"")
    )


def chunks(journal: Journal, parameters: str) -> list[JournalChunk]:
    return [JournalChunk.from_bytes(reply) for reply in ask(journal, "range", parameters)]


def test_chunks_follow_on_each_other_and_hold_everything(journal):
    answers = chunks(journal, "epoch=9;from=1;to=100;bytes=1000")
    assert len(answers) > 5
    assert [chunk.from_seq for chunk in answers] == [1] + [c.to_seq + 1 for c in answers[:-1]]
    assert answers[-1].to_seq == 100
    kept = [entry.seq for chunk in answers for entry in chunk.entries]
    assert kept == [seq for seq in range(1, 101) if seq != 50]


def test_total_bounds_the_answer_but_lets_one_message_through(journal):
    answers = chunks(journal, "epoch=9;from=1;to=100;bytes=500;total=1000")
    assert [(chunk.from_seq, chunk.to_seq) for chunk in answers] == [(1, 5), (6, 9)]
    (chunk,) = chunks(journal, "epoch=9;from=1;to=100;total=1")
    assert (chunk.from_seq, chunk.to_seq) == (1, 1)


def test_bounds_in_bytes_are_kept_to_the_byte(journal):
    """Each message is said to take 24 bytes beside its own 100."""
    (chunk,) = chunks(journal, "epoch=9;from=1;to=100;total=248")
    assert (chunk.from_seq, chunk.to_seq) == (1, 2)
    answers = chunks(journal, "epoch=9;from=1;to=6;bytes=248")
    assert [(chunk.from_seq, chunk.to_seq) for chunk in answers] == [(1, 2), (3, 4), (5, 6)]


def test_no_reply_is_larger_than_a_megabyte_whatever_is_asked_for(journal):
    """It is made in memory, and a journal has half a gigabyte."""
    journal.append([JournalRow(seq, POSITION, 0, bytes(100_000)) for seq in range(101, 131)])
    answers = chunks(journal, f"epoch=9;from=101;to=130;bytes={10**12};total={10**12}")
    assert [len(chunk.entries) for chunk in answers] == [11, 11, 8]


def test_a_single_number_that_is_not_kept_is_stated_to_be_gone(journal):
    (chunk,) = chunks(journal, "epoch=9;from=50;to=50")
    assert (chunk.from_seq, chunk.to_seq, chunk.entries) == (50, 50, ())


def test_raw_samples_are_given_by_themselves(journal):
    journal.append([JournalRow(101, POSITION, 0, b"here"), JournalRow(102, IMU, 0, b"samples")])
    (answer,) = ask(journal, "raw", "epoch=9;from=90;to=102")
    chunk = JournalChunk.from_bytes(answer)
    assert [entry.seq for entry in chunk.entries] == [102]
    assert (chunk.from_seq, chunk.to_seq) == (90, 102)
    assert (chunk.raw_only, chunk.urgent_only) == (True, False)
    assert not any(one.raw_only for one in chunks(journal, "epoch=9;from=90;to=102"))


def test_max_bounds_the_answer_and_its_end_says_where_to_go_on(journal):
    (chunk,) = chunks(journal, "epoch=9;from=41;to=100;max=10")
    assert [entry.seq for entry in chunk.entries] == [41, 42, 43, 44, 45, 46, 47, 48, 49, 51]
    assert (chunk.from_seq, chunk.to_seq) == (41, 51)


def test_unwritten_messages_are_not_reported_as_lost(journal):
    (chunk,) = chunks(journal, "epoch=9;from=99;to=200")
    assert chunk.to_seq == 100
    assert not chunks(journal, "epoch=9;from=101;to=200")


def test_boot_of_another_machine_is_not_served(journal):
    assert not chunks(journal, "epoch=1234;from=1;to=5")


def test_completely_deleted_boot_is_reported_as_gone(tmp_path):
    path = tmp_path / "journal.sqlite"
    Journal(path, lambda: 1234, 123, 10**8).close()
    journal = Journal(path, lambda: 9, 123, 10**8)
    (chunk,) = chunks(journal, "epoch=1234;from=1;to=5")
    assert (chunk.from_seq, chunk.to_seq, chunk.entries) == (1, 5, ())
    journal.close()


def test_messages_after_damage_are_served(journal, tmp_path):
    """A page that cannot be read would be asked for every second, and nothing else of that boot."""
    journal.append([JournalRow(seq, POSITION, 0, bytes(100)) for seq in range(101, 2001)])
    journal.close()
    file = tmp_path / "journal.sqlite"
    spoil_page(file, SOME_LEAF)
    damaged = Journal(file, lambda: 10, 123, 10**8)
    answers = chunks(damaged, "epoch=9;from=1;to=2000")
    assert (answers[0].from_seq, answers[-1].to_seq) == (1, 2000)
    assert [chunk.from_seq for chunk in answers[1:]] == [c.to_seq + 1 for c in answers[:-1]]
    kept = [entry.seq for chunk in answers for entry in chunk.entries]
    (hole,) = [
        after - before for before, after in itertools.pairwise(kept[49:]) if after > before + 1
    ]
    assert 10 < hole < 100
    assert len(kept) == 2000 - hole
    damaged.close()


def test_the_alerts_of_a_range_are_given_by_themselves(journal):
    alerts = [JournalRow(seq, EVENT, 0, b"fall") for seq in (104, 140)]
    others = [JournalRow(seq, POSITION, 0, bytes(100)) for seq in range(101, 161)]
    journal.append([one for one in others if one.seq not in (104, 140)] + alerts)
    question = "epoch=9;from=50;to=160;bytes=500;total=1000"
    (answer,) = ask(journal, "urgent", question)
    chunk = JournalChunk.from_bytes(answer)
    assert [entry.seq for entry in chunk.entries] == [104, 140]
    assert (chunk.from_seq, chunk.to_seq, chunk.urgent_only) == (50, 160, True)
    assert not any(one.urgent_only for one in chunks(journal, question))


def test_index_and_acknowledgement(journal):
    (index,) = ask(journal, "index")
    (boot,) = JournalIndex.from_bytes(index).boots
    assert (boot.boot_id, boot.first_seq, boot.last_seq, boot.acknowledged_seq) == (9, 1, 100, 0)
    (index,) = ask(journal, "acknowledge", "epoch=9;to=70")
    assert JournalIndex.from_bytes(index).boots[0].acknowledged_seq == 70
    ask(journal, "acknowledge", "epoch=9;to=60")  # never back
    assert journal.pending == 30
    (index,) = ask(journal, "acknowledge", "epoch=9;to=80;newest=0")
    assert JournalIndex.from_bytes(index).boots == ()
    assert journal.pending == 20


def test_newest_of_many_runs_are_listed(tmp_path, monkeypatch):
    monkeypatch.setattr("edge.storage.journal.server._MOST_BOOTS", 20)
    boot_ids = itertools.count(1)
    for _ in range(30):
        with closing(Journal(tmp_path / "many.sqlite", boot_ids.__next__, 0, 10**9)) as many:
            many.append([JournalRow(1, EVENT, 0, b"started")])
    for question, first in (("", 11), ("newest=3", 28), ("newest=1000", 11), ("newest=-1", 31)):
        (index,) = ask(many, "index", question)
        named = [boot.boot_id for boot in JournalIndex.from_bytes(index).boots]
        assert named == list(range(first, 31))


@pytest.mark.parametrize(
    ("what", "parameters"),
    [
        ("range", ""),
        ("range", "epoch=9;from=1"),
        ("range", "epoch=x;from=1;to=2"),
        ("range", "epoch=9;from=1;to"),
        ("range", f"epoch={2**70};from=1;to=2"),
        ("everything", ""),
        ("acknowledge", "epoch=8;to=" + "9" * 30),
    ],
)
def test_questions_without_sense_get_nothing_and_break_nothing(journal, what, parameters):
    assert ask(journal, what, parameters) == []
    assert len(chunks(journal, "epoch=9;from=1;to=100")) == 1


def test_lasting_fault_is_reported_once_and_again_when_it_recurs(journal, caplog, monkeypatch):
    full = StoreError("database or disk is full")

    def refuse(*_: object) -> None:
        raise full

    server = JournalServer("u1", journal)
    for works in (False, False, True, False):
        with monkeypatch.context() as patch:
            if not works:
                patch.setattr(journal, "acknowledge", refuse)
            list(server.replies("muster/v1/u1/journal/acknowledge", "epoch=9;to=5", b""))
    reported = [one for one in caplog.records if one.levelno == logging.ERROR]
    assert len(reported) == 2
