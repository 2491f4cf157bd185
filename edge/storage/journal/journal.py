"""The journal of everything a unit sends: on disk before it is on the air.

One SQLite file in WAL mode with ``synchronous=FULL``: what ``append`` has returned from
survives ``kill -9`` and power loss.

A file that turns out to be damaged while it is in use is left alone: who reads it has it open.  A
new one is begun beside it, and takes its name at the next start.
"""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from itertools import islice
from pathlib import Path
from threading import Lock, Thread
from typing import NamedTuple

from edge.storage.journal.database_file import (
    DAMAGE,
    REFUSAL,
    as_store_error,
    code_of,
    connect,
    is_no_journal,
    rename,
    replacement_of,
)
from edge.storage.journal.eviction import bytes_used, evict
from edge.storage.journal.schema import (
    EVERYTHING,
    SCHEMA,
    boots,
    bounds,
    earlier_alerts,
    entries,
    priority_of,
)
from shared.channels import Channel
from shared.coded_text import coded
from shared.errors import StoreError
from shared.messages import JournalBoot, JournalEntry

logger = logging.getLogger(__name__)

_LOCK_TIMEOUT_S = 1.0  # of who could as well ask again
_CLOSING_S = 2.0
_NO_BOOT_YET = 2**63 - 1  # above every number of a boot


class JournalRow(NamedTuple):
    """Message on its way into the journal."""

    seq: int
    channel: Channel
    t_utc_ns: int
    payload: bytes


class EarlierAlert(NamedTuple):
    """Alert of an earlier boot."""

    boot: int  # they are counted in the order in which they began
    channel: Channel
    payload: bytes


class Journal:
    """Journal of one unit; one process writes it.

    Any thread may call any method.  All raise StoreError when the disk does not do as asked.
    """

    def __init__(
        self, path: Path, new_boot_id: Callable[[], int], started_utc_ns: int, limit_bytes: int
    ) -> None:
        """Open or make the journal and begin a boot with an id that no earlier boot had.

        Where the disk refuses, the first ``append`` for which it has room begins the boot.
        """
        self._path = path
        self._started_utc_ns = started_utc_ns
        self._limit_bytes = limit_bytes
        self._lock = Lock()
        self._acknowledged_seq = 0
        self.first_seq = 1  # the oldest of this boot that is kept
        self.last_seq = 0  # the newest of this boot that is on disk
        self.rows_evicted = 0  # unacknowledged messages given up for room
        self.damage: str = ""  # why a new file was begun, for a person
        self._read_damage = ""  # the same, as a reader has found out
        self._connection: sqlite3.Connection | None = None
        self._boot = 0
        self.boot_id = new_boot_id()
        with as_store_error(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            try:
                while not self._begin_boot():
                    self.boot_id = new_boot_id()
            except sqlite3.Error as error:
                if code_of(error) not in REFUSAL:
                    raise

    @property
    def acknowledged_seq(self) -> int:
        """Number up to which the station has all messages of this boot safe; 0: of none."""
        return self._acknowledged_seq

    @property
    def pending(self) -> int:
        """Messages of this boot that the station is not known to have."""
        return max(0, self.last_seq - self._acknowledged_seq)

    def append(self, messages: Sequence[JournalRow]) -> None:
        """Put messages on disk, all or none; returns when they are safe."""
        with as_store_error(self._path), self._lock:
            if self._read_damage and not self.damage:
                self._replace_file(self._read_damage)
            try:
                self._insert(messages)
            except sqlite3.Error as error:
                if self.damage or code_of(error) not in DAMAGE:
                    raise
                self._replace_file(str(error))
                self._insert(messages)

    def read(
        self, boot_id: int, from_seq: int, to_seq: int, priorities: Sequence[int] = EVERYTHING
    ) -> Iterator[JournalEntry]:
        """Yield what is kept of these sequence numbers, in order; both ends belong to the range.

        Of all, or of ``URGENT`` or ``RAW`` messages only.  What damage hides is not kept any more:
        else nothing behind it would ever be asked for.

        Reads while it is iterated, beside the writer.
        """
        with as_store_error(self._path), closing(connect(self._path)) as reader:
            past = 1
            while from_seq <= to_seq:
                try:
                    for entry in entries(reader, boot_id, from_seq, to_seq, priorities):
                        if entry.seq >= from_seq:  # one whose number is damaged comes twice
                            yield entry
                            from_seq, past = entry.seq + 1, 1
                except sqlite3.Error as error:
                    if code_of(error) not in DAMAGE:
                        raise
                    if past == 1:
                        logger.warning("the journal is damaged at message %d: %s", from_seq, error)
                    from_seq, past = from_seq + past, 2 * past
                else:
                    return

    def boots(self, newest: int | None = None) -> tuple[JournalBoot, ...]:
        """Return the boots that can be served, oldest first: the ``newest``, or all of them.

        Raises StoreError where they cannot be read.
        """
        path = self._path
        with as_store_error(path), closing(connect(path)) as reader:
            try:
                return tuple(islice(boots(reader), newest))[::-1]
            except sqlite3.Error as error:
                # Where the list of boots cannot be read, the station will ask for none of them.
                if path == self._path and code_of(error) in DAMAGE:
                    self._read_damage = str(error)
                raise

    def has_boot(self, boot_id: int) -> bool:
        """Return True if this boot was ever written here, though nothing of it may be left."""
        with as_store_error(self._path), closing(connect(self._path)) as reader:
            found = reader.execute("SELECT 1 FROM boot WHERE boot_id = ?", (boot_id,))
            return found.fetchone() is not None

    def earlier_alerts(self, *channels: Channel) -> Iterator[EarlierAlert]:
        """Yield what is kept of these channels of alerts of the boots before this one, newest
        first.

        Reads while it is iterated.  Damage hides the alerts before it in the same boot; those of
        earlier boots are given all the same.
        """
        suffixes = {channel.suffix: channel for channel in channels}
        below, past = self._boot or _NO_BOOT_YET, 1
        with as_store_error(self._path), closing(connect(self._path)) as reader:
            while below > 0:
                before = below
                try:
                    for below, suffix, payload in earlier_alerts(reader, before, [*suffixes]):
                        yield EarlierAlert(below, suffixes[suffix], payload)
                except sqlite3.Error as error:
                    if code_of(error) not in DAMAGE:
                        raise
                    if below < before:
                        logger.warning("the journal is damaged at start %d: %s", below, error)
                        past = 1
                    else:
                        below, past = below - past, 2 * past
                else:
                    return

    def acknowledge(self, boot_id: int, to_seq: int) -> None:
        """Record that the station has everything of this boot up to ``to_seq`` on its own disk.

        Of what is still to come it can have nothing, whatever it says.
        """
        if boot_id == self.boot_id:
            to_seq = min(to_seq, self.last_seq)
        with as_store_error(self._path), self._exclusive(), self._writer:
            self._writer.execute(
                "UPDATE boot SET acknowledged_seq = MAX(acknowledged_seq, ?) WHERE boot_id = ?",
                (to_seq, boot_id),
            )
            if boot_id == self.boot_id:
                self._acknowledged_seq = max(self._acknowledged_seq, to_seq)

    def close(self) -> None:
        """Close the file; what was appended is safe already, and a disk that hangs is left to
        the end of the process.

        A thread waits for it: it may hang in another one that writes, or only now.
        """
        closing = Thread(target=self._close, name="journal-closing", daemon=True)
        closing.start()
        closing.join(_CLOSING_S)
        if closing.is_alive():
            logger.error("the journal %s is not closed: its disk does not answer", self._path)

    def _close(self) -> None:
        with self._lock:
            if self._connection is not None:
                self._connection.close()

    @contextmanager
    def _exclusive(self) -> Iterator[None]:
        """Hold the lock, but wait for it a second only: a disk that hangs in another thread must
        not block a query for what can be read.
        """
        if not self._lock.acquire(timeout=_LOCK_TIMEOUT_S):
            raise StoreError(f"the journal {self._path} hangs: its disk does not answer")
        try:
            yield
        finally:
            self._lock.release()

    def _insert(self, messages: Sequence[JournalRow]) -> None:
        """Insert rows, after evicting others: what is safe must not be reported as failed and
        come again.
        """
        if bytes_used(self._writer) > self._limit_bytes:
            self._evict()
        rows = [
            (priority_of(each.channel), self._boot, each.seq, each.channel.suffix, each.t_utc_ns,
             each.payload)
            for each in messages
        ]  # fmt: skip
        with self._writer:
            self._writer.executemany("INSERT INTO message VALUES (?, ?, ?, ?, ?, ?)", rows)
        self.last_seq = max(self.last_seq, *(each.seq for each in messages))

    def _replace_file(self, damage: str) -> None:
        """Begin a new file, once: a disk that damages it as well is not filled with more of
        them.
        """
        self.damage = coded(
            "journal-damaged",
            "the journal is damaged ({damage}); it is left alone, and a new one is begun",
            damage=damage,
        )
        self.first_seq = self.last_seq + 1
        if self._connection is not None:
            self._connection.close()
            self._connection = None
        self._path = replacement_of(self._path)

    @property
    def _writer(self) -> sqlite3.Connection:
        """Connection of a boot that has begun; for one thread at a time."""
        if self._connection is None and not self._begin_boot():
            raise StoreError(f"the journal {self._path} has another boot {self.boot_id:x}")
        assert self._connection is not None
        return self._connection

    def _begin_boot(self) -> bool:
        """Begin the boot; return False if an earlier boot had this one's id."""
        connection = connect(self._path)
        with ExitStack() as on_error:
            on_error.callback(connection.close)
            connection.executescript(SCHEMA)
            try:
                with connection:
                    cursor = connection.execute(
                        "INSERT INTO boot (boot_id, started_utc_ns) VALUES (?, ?)",
                        (self.boot_id, self._started_utc_ns),
                    )
            except sqlite3.IntegrityError:
                return False
            assert cursor.lastrowid is not None
            self._boot = cursor.lastrowid
            self._connection = connection
            on_error.pop_all()
        return True

    def _evict(self) -> None:
        self.rows_evicted += evict(self._writer, self._limit_bytes)
        kept = bounds(self._writer, self._boot)
        self.first_seq = self.last_seq + 1 if kept is None else kept[0]


def open_journal(
    path: Path, new_boot_id: Callable[[], int], started_utc_ns: int, limit_bytes: int
) -> tuple[Journal, Path | None]:
    """Open the journal; one that is damaged, or was when it was last used, is moved to the path
    that is returned.
    """
    quarantine = path.with_name(f"{path.name}.damaged-{started_utc_ns}")
    with as_store_error(path):
        is_followed = replacement_of(path).exists()
        if is_followed:
            if path.exists():  # else the power went while they were renamed: what is there is new
                rename(path, quarantine)
            rename(replacement_of(path), path)
    try:
        journal = Journal(path, new_boot_id, started_utc_ns, limit_bytes)
    except StoreError as error:
        if not is_no_journal(error.__cause__):
            raise
    else:
        return journal, quarantine if is_followed else None
    with as_store_error(path):
        rename(path, quarantine)
    return Journal(path, new_boot_id, started_utc_ns, limit_bytes), quarantine
