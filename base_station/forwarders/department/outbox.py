"""Outbox of a station: events for its department, in a file of its own in the data folder.

An event gets a number here and is kept until the department has acknowledged it.  The file also has
the last report on each subject, and the position up to which the log was collected, so that a
station that was killed reports the changes since.
"""

from __future__ import annotations

import os
import secrets
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from threading import Lock
from typing import NamedTuple

from shared.errors import StoreError
from shared.own_files import open_own

_SCHEMA = """
CREATE TABLE IF NOT EXISTS meta (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS events (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    event_id TEXT NOT NULL UNIQUE,
    subject TEXT NOT NULL,
    t_ms INTEGER NOT NULL,
    body BLOB NOT NULL
);
CREATE TABLE IF NOT EXISTS reported (subject TEXT PRIMARY KEY, state BLOB NOT NULL) WITHOUT ROWID;
"""
# Deleted data is overwritten; committed data survives a power cut.
_PRAGMAS = ("journal_mode = WAL", "synchronous = FULL", "secure_delete = ON")
_EPOCH, _ACKNOWLEDGED, _DROPPED = "epoch", "acknowledged", "dropped"
_COLLECTED = "collected_ns"


class NewEvent(NamedTuple):
    """An event that has no number yet."""

    event_id: str
    subject: str
    t_ms: int  # station time
    body: bytes


class StoredEvent(NamedTuple):
    seq: int
    event_id: str
    t_ms: int
    body: bytes


class DepartmentOutbox:
    """Outbox in a file.  Thread-safe.  The file is opened when it is first used.  A damaged one is
    set aside as ``NAME.damaged``, and everything is then reported again.

    All methods raise StoreError if the disk fails.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = Lock()
        self._opened: sqlite3.Connection | None = None

    @property
    def epoch(self) -> int:
        """Random number of this outbox; another number means another machine or a new outbox."""
        epoch = self._meta(_EPOCH)
        assert epoch is not None
        return epoch

    @property
    def acknowledged_seq(self) -> int:
        return self._meta(_ACKNOWLEDGED) or 0

    @property
    def dropped_seq(self) -> int:
        """Last number that ``keep_newest`` has dropped; 0 if none."""
        return self._meta(_DROPPED) or 0

    @property
    def collected_ns(self) -> int | None:
        """Station time up to which the log was collected; None: it never was."""
        return self._meta(_COLLECTED)

    @property
    def waiting(self) -> int:
        """Number of events that are not acknowledged."""
        with self._transaction() as database:
            ((count,),) = database.execute("SELECT count(*) FROM events")
        return int(count)

    def reported(self) -> dict[str, bytes]:
        """State that was reported last, by subject."""
        with self._transaction() as database:
            return dict(database.execute("SELECT subject, state FROM reported").fetchall())

    def add(
        self,
        events: Sequence[NewEvent],
        reported: Mapping[str, bytes | None],
        collected_ns: int | None,
    ) -> None:
        """Store events with the reports of their subjects, together or not at all; an event that is
        there already stays as it is.  ``reported``: None removes a subject.
        """
        with self._transaction() as database:
            # An event that SQLite ignores because of its id would use up a number.
            database.executemany(
                "INSERT INTO events (event_id, subject, t_ms, body) SELECT :id, :subject, :t_ms, "
                ":body WHERE NOT EXISTS (SELECT 1 FROM events WHERE event_id = :id)",
                [
                    {"id": one.event_id, "subject": one.subject, "t_ms": one.t_ms, "body": one.body}
                    for one in events
                ],
            )
            for subject, state in reported.items():
                if state is None:
                    database.execute("DELETE FROM reported WHERE subject = ?", (subject,))
                else:
                    database.execute("REPLACE INTO reported VALUES (?, ?)", (subject, state))
            if collected_ns is not None:
                database.execute("REPLACE INTO meta VALUES (?, ?)", (_COLLECTED, collected_ns))

    def rewrite(self, subject: str, body: bytes) -> None:
        """Replace the bodies of all waiting events of a subject, so that nothing of them is
        left.
        """
        with self._transaction() as database:
            database.execute("UPDATE events SET body = ? WHERE subject = ?", (body, subject))

    def next_batch(self, max_events: int, max_bytes: int) -> tuple[StoredEvent, ...]:
        """Oldest waiting events; at least one if there is one."""
        batch: list[StoredEvent] = []
        size_bytes = 0
        with self._transaction() as database:
            rows = database.execute(
                "SELECT seq, event_id, t_ms, body FROM events ORDER BY seq LIMIT ?", (max_events,)
            )
            for row in rows:
                event = StoredEvent(*row)
                size_bytes += len(event.body) + len(event.event_id)
                if batch and size_bytes > max_bytes:
                    break
                batch.append(event)
        return tuple(batch)

    def acknowledge(self, seq: int) -> None:
        """Note that the department has all events up to ``seq`` on its disk."""
        with self._transaction() as database:
            _delete(database, seq, _ACKNOWLEDGED)

    def keep_newest(self, count: int) -> None:
        """Drop older events: of two stations the other one has sent them."""
        with self._transaction() as database:
            ((newest,),) = database.execute("SELECT coalesce(max(seq), 0) FROM events")
            _delete(database, newest - count, _DROPPED)

    def close(self) -> None:
        with self._lock:
            if self._opened is not None:
                self._opened.close()
                self._opened = None

    def _meta(self, name: str) -> int | None:
        with self._transaction() as database:
            row = database.execute("SELECT value FROM meta WHERE name = ?", (name,)).fetchone()
        return None if row is None else int(row[0])

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        with self._lock:
            try:
                database = self._database()
                with ExitStack() as undo:
                    database.execute("BEGIN")
                    undo.callback(_roll_back, database)
                    yield database
                    database.execute("COMMIT")
                    undo.pop_all()
            except (sqlite3.Error, OSError) as error:
                raise StoreError(f"{self._path} cannot be used: {error}") from error

    def _database(self) -> sqlite3.Connection:
        if self._opened is None:
            try:
                self._opened = self._open()
            except sqlite3.OperationalError:  # of the disk
                raise
            except sqlite3.DatabaseError:
                _set_aside(self._path)
                self._opened = self._open()
        return self._opened

    def _open(self) -> sqlite3.Connection:
        with suppress(FileExistsError):
            os.close(open_own(self._path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        with ExitStack() as undo:
            database = sqlite3.connect(self._path, isolation_level=None, check_same_thread=False)
            undo.callback(database.close)
            for pragma in _PRAGMAS:
                database.execute(f"PRAGMA {pragma}")
            database.executescript(_SCHEMA)
            for row in ((_EPOCH, secrets.randbits(63)), (_ACKNOWLEDGED, 0), (_DROPPED, 0)):
                database.execute("INSERT OR IGNORE INTO meta VALUES (?, ?)", row)
            undo.pop_all()
        return database


def _delete(database: sqlite3.Connection, seq: int, reason: str) -> None:
    database.execute("DELETE FROM events WHERE seq <= ?", (seq,))
    database.execute("UPDATE meta SET value = max(value, ?) WHERE name = ?", (seq, reason))


def _roll_back(database: sqlite3.Connection) -> None:
    """Roll back, without hiding the failure that led here by one of the rollback."""
    with suppress(sqlite3.Error):
        database.execute("ROLLBACK")


def _set_aside(path: Path) -> None:
    path.replace(path.with_name(f"{path.name}.damaged"))
    for name in ("-wal", "-shm"):
        path.with_name(path.name + name).unlink(missing_ok=True)
