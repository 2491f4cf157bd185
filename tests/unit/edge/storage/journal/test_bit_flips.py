"""A bit that flips in the journal hides the message in which it is, and nothing else.

SQLite has no checksums: in most places it gives a flipped bit as if it had been written.
"""

from __future__ import annotations

import itertools
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from edge.agent.restore_state import answers_before, mayday_before
from edge.storage.journal.journal import Journal, JournalRow, open_journal
from edge.storage.journal.server import JournalServer
from shared.channels import EVENT, POSITION
from shared.clock import ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import EventKind, JournalChunk, JournalIndex, UnitEvent

COUNT = 60
ALERT_AT = 30  # all others are positions


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A journal of one boot, with a mayday in its middle."""
    header_factory = HeaderFactory("u1", 1, ManualClock())
    mayday = encode(UnitEvent(header_factory.header(), EventKind.MAYDAY))
    path = tmp_path / "journal.sqlite"
    journal = Journal(path, lambda: 1, 1_000, 10**8)
    positions = [JournalRow(seq, POSITION, 0, bytes(50)) for seq in range(1, COUNT + 1)]
    positions[ALERT_AT - 1] = JournalRow(ALERT_AT, EVENT, 0, mayday)
    journal.append(positions)
    journal.close()
    return path


def change(path: Path, statement: str) -> None:
    with closing(sqlite3.connect(path)) as journal, journal:
        journal.execute(statement)


def opened(path: Path) -> Journal:
    journal, quarantine = open_journal(path, itertools.count(2).__next__, 2_000, 10**8)
    assert quarantine is None
    return journal


def served(journal: Journal, what: str) -> list[int]:
    """Messages for a station that queries repeatedly from the end of the last answer."""
    server = JournalServer("u1", journal)
    seqs: list[int] = []
    first = 1
    while first <= COUNT:
        question = f"epoch=1;from={first};to={COUNT};total=1000"
        replies = list(server.replies(f"muster/v1/u1/journal/{what}", question, b""))
        assert replies, f"it would ask for {first} for ever"
        for chunk in map(JournalChunk.from_bytes, replies):
            assert chunk.from_seq == first
            seqs += [entry.seq for entry in chunk.entries]
            first = chunk.to_seq + 1
    return seqs


@pytest.mark.parametrize("seq", [20, ALERT_AT])
@pytest.mark.parametrize(
    "damage",
    [
        "suffix = CAST(x'75702fff' AS TEXT)",
        "suffix = x'75702f'",
        "payload = 77",
        "payload = CAST(x'ffff' AS TEXT)",
        "payload = 0.5",
        "seq = seq + 0.5",
    ],
)
def test_messages_after_the_damage_are_served(path: Path, seq: int, damage: str) -> None:
    change(path, f"UPDATE message SET {damage} WHERE seq = {seq}")
    journal = opened(path)
    assert served(journal, "range") == [one for one in range(1, COUNT + 1) if one != seq]
    assert served(journal, "urgent") == [one for one in (ALERT_AT,) if one != seq]
    journal.close()


def test_a_number_that_stands_twice_is_given_once(path: Path) -> None:
    """In the part of another worth, where the bit is in that."""
    change(path, "INSERT INTO message SELECT 1, boot, 20, suffix, 0, payload FROM message LIMIT 1")
    journal = opened(path)
    assert served(journal, "range") == list(range(1, COUNT + 1))
    journal.close()


@pytest.mark.parametrize("damage", ["77", "CAST(x'ffff' AS TEXT)"])
def test_damaged_journal_does_not_prevent_the_start(path: Path, damage: str) -> None:
    change(path, f"INSERT INTO message SELECT worth, boot, 99, suffix, 0, {damage} FROM message "
                 f"WHERE seq = {ALERT_AT}")  # fmt: skip
    journal = opened(path)
    assert mayday_before(journal)
    assert answers_before(journal) == []
    journal.close()


@pytest.mark.parametrize(
    "damage",
    [
        "boot_id = 'one'",
        "boot_id = -5",
        "acknowledged_seq = x'01'",
        "acknowledged_seq = -1",
        "started_utc_ns = 0.5",
    ],
)
def test_a_boot_that_makes_no_sense_keeps_no_other_from_being_named(
    path: Path, damage: str
) -> None:
    change(path, f"UPDATE boot SET {damage}")
    journal = opened(path)
    journal.append([JournalRow(1, EVENT, 0, b"here")])
    (index,) = JournalServer("u1", journal).replies("muster/v1/u1/journal/index", "", b"")
    assert [boot.boot_id for boot in JournalIndex.from_bytes(index).boots] == [journal.boot_id]
    journal.close()


def test_numbers_that_make_no_sense_keep_no_boot_from_being_named(path: Path) -> None:
    change(path, f"UPDATE message SET seq = 'x' WHERE seq = {ALERT_AT}")
    journal = opened(path)
    assert [(boot.first_seq, boot.last_seq) for boot in journal.boots()] == [(1, COUNT)]
    journal.close()


def test_a_schema_that_is_no_text_is_a_damaged_journal(path: Path) -> None:
    content = path.read_bytes()
    at = content.index(b"CREATE TABLE message") + len("CREATE ")
    path.write_bytes(content[:at] + b"\xa8" + content[at + 1 :])
    journal, quarantine = open_journal(path, itertools.count(2).__next__, 2_000, 10**8)
    assert quarantine is not None
    journal.append([JournalRow(1, EVENT, 0, b"here")])
    journal.close()
