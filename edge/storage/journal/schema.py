"""Schema of the journal's file, and queries on a connection.

Messages are named by boot id and sequence number, as in their headers.  Rows are clustered by how
much they are worth, so that making room frees whole pages.
"""

from __future__ import annotations

import heapq
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import suppress
from operator import itemgetter

from shared.channels import GPS, IMU, POSITION, Channel, Qos
from shared.messages import JournalBoot, JournalEntry

SCHEMA = """
CREATE TABLE IF NOT EXISTS boot (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    boot_id INTEGER NOT NULL UNIQUE,
    started_utc_ns INTEGER NOT NULL,
    acknowledged_seq INTEGER NOT NULL DEFAULT 0
);
CREATE TABLE IF NOT EXISTS message (
    worth INTEGER NOT NULL,
    boot INTEGER NOT NULL REFERENCES boot(number),
    seq INTEGER NOT NULL,
    suffix TEXT NOT NULL,
    t_utc_ns INTEGER NOT NULL,
    payload BLOB NOT NULL,
    PRIMARY KEY (worth, boot, seq)
) WITHOUT ROWID;
"""
_RAW, _ROUTINE, _TRACK, _ALERT = PRIORITIES = tuple(range(4))  # the least first
EVERYTHING, URGENT, RAW = PRIORITIES, (_ALERT,), (_RAW,)


def priority_of(channel: Channel) -> int:
    if channel is IMU:
        return _RAW
    if channel in (POSITION, GPS):
        return _TRACK
    return _ALERT if channel.qos is Qos.ALERT else _ROUTINE


def entries(
    connection: sqlite3.Connection,
    boot_id: int,
    from_seq: int,
    to_seq: int,
    priorities: Sequence[int],
) -> Iterator[JournalEntry]:
    """Yield rows without those of wrong types, which a flipped bit has caused: SQLite does not
    check types when it reads.
    """
    parts = [
        connection.execute(
            "SELECT seq, CAST(suffix AS BLOB), payload FROM message WHERE worth = ? AND "
            "boot = (SELECT number FROM boot WHERE boot_id = ?) AND "
            "seq BETWEEN ? AND ? AND typeof(seq) = 'integer' AND typeof(suffix) = 'text' "
            "AND typeof(payload) = 'blob' ORDER BY seq",
            (priority, boot_id, from_seq, to_seq),
        )
        for priority in priorities
    ]
    for seq, suffix, payload in heapq.merge(*parts, key=itemgetter(0)):
        with suppress(UnicodeDecodeError):
            yield JournalEntry(seq, suffix.decode(), payload)


def boots(connection: sqlite3.Connection) -> Iterator[JournalBoot]:
    """Yield boots, newest first, each queried when it is needed."""
    for number, boot_id, acknowledged_seq, started_utc_ns in connection.execute(
        "SELECT number, boot_id, acknowledged_seq, started_utc_ns FROM boot "
        "WHERE typeof(boot_id) = 'integer' AND typeof(acknowledged_seq) = 'integer' "
        "AND typeof(started_utc_ns) = 'integer' AND boot_id > 0 AND acknowledged_seq >= 0 "
        "ORDER BY number DESC"
    ):
        kept = bounds(connection, number)
        if kept is not None:
            yield JournalBoot(boot_id, *kept, acknowledged_seq, started_utc_ns)


def bounds(connection: sqlite3.Connection, boot: int) -> tuple[int, int] | None:
    """Return first and last sequence number kept of one boot."""
    # Each in a query of its own: both in one would read every message that is between them.
    found = [
        connection.execute(
            "SELECT (SELECT MIN(seq) FROM message WHERE worth = :worth AND boot = :boot), "
            "(SELECT MAX(seq) FROM message WHERE worth = :worth AND boot = :boot)",
            {"worth": priority, "boot": boot},
        ).fetchone()
        for priority in PRIORITIES
    ]
    kept = [pair for pair in found if all(isinstance(seq, int) and seq > 0 for seq in pair)]
    if not kept:
        return None
    return min(first for first, _ in kept), max(last for _, last in kept)


def earlier_alerts(
    connection: sqlite3.Connection, boot: int, suffixes: Sequence[str]
) -> Iterator[tuple[int, str, bytes]]:
    """Yield the alerts of the boots before one that stand under these suffixes, the newest
    first.

    Boot by boot in one pass: to ask for each boot by itself would take seconds where a program has
    started again and again.
    """
    yield from connection.execute(
        "SELECT boot, suffix, payload FROM message WHERE worth = ? AND boot < ? "  # noqa: S608  # all text is ours
        f"AND suffix IN ({', '.join('?' * len(suffixes))}) "
        "AND typeof(boot) = 'integer' AND typeof(payload) = 'blob' "
        "ORDER BY boot DESC, seq DESC",
        (_ALERT, boot, *suffixes),
    )
