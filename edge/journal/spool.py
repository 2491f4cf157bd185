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

from edge.journal.file import (
    DAMAGE,
    REFUSAL,
    anew,
    code_of,
    connect,
    in_words,
    is_no_journal,
    rename,
)
from edge.journal.room import bytes_used, make_room
from edge.journal.rows import (
    EVERYTHING,
    SCHEMA,
    boots,
    bounds,
    entries,
    said_before,
    worth_of,
)
from shared.channels import Channel
from shared.errors import StoreError
from shared.messages import JournalBoot, JournalEntry

logger = logging.getLogger(__name__)

_PATIENCE_S = 1.0  # of who could as well ask again
_CLOSING_S = 2.0
_NO_BOOT_YET = 2**63 - 1  # above every number of a boot


class Journaled(NamedTuple):
    """One message on its way into the journal."""

    seq: int
    channel: Channel
    t_utc_ns: int
    payload: bytes


class SaidBefore(NamedTuple):
    """An alert of an earlier boot."""

    boot: int  # they are counted in the order in which they began
    channel: Channel
    payload: bytes


class Spool:
    """The journal of one unit; one process writes it.

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
        self.rows_freed = 0  # unacknowledged messages given up for room
        self.damage = ""  # why a new file was begun, for a person
        self._unreadable = ""  # the same, as a reader has found out
        self._connection: sqlite3.Connection | None = None
        self._boot = 0
        self.boot_id = new_boot_id()
        with in_words(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            try:
                while not self._begin_boot():
                    self.boot_id = new_boot_id()
            except sqlite3.Error as error:
                if code_of(error) not in REFUSAL:
                    raise

    @property
    def pending(self) -> int:
        """Messages of this boot that the station is not known to have."""
        return max(0, self.last_seq - self._acknowledged_seq)

    def append(self, messages: Sequence[Journaled]) -> None:
        """Put messages on disk, all or none; returns when they are safe."""
        with in_words(self._path), self._lock:
            if self._unreadable and not self.damage:
                self._begin_anew(self._unreadable)
            try:
                self._insert(messages)
            except sqlite3.Error as error:
                if self.damage or code_of(error) not in DAMAGE:
                    raise
                self._begin_anew(str(error))
                self._insert(messages)

    def read(
        self, boot_id: int, from_seq: int, to_seq: int, worths: Sequence[int] = EVERYTHING
    ) -> Iterator[JournalEntry]:
        """What is kept of these sequence numbers, in order; both ends belong to the range.

        Of all, or of ``URGENT`` or ``RAW`` messages only.  What damage hides is not kept any more:
        else nothing behind it would ever be asked for.

        Reads while it is iterated, beside the writer.
        """
        with in_words(self._path), closing(connect(self._path)) as reader:
            past = 1
            while from_seq <= to_seq:
                try:
                    for entry in entries(reader, boot_id, from_seq, to_seq, worths):
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
        """What can be served, oldest boot first, of the ``newest`` or of all of them; boots of
        which nothing is left are not named.
        """
        path = self._path
        with in_words(path), closing(connect(path)) as reader:
            try:
                return tuple(islice(boots(reader), newest))[::-1]
            except sqlite3.Error as error:
                # Where nobody can be told what there is, nothing of it will be asked for.
                if path == self._path and code_of(error) in DAMAGE:
                    self._unreadable = str(error)
                raise

    def has_boot(self, boot_id: int) -> bool:
        """Whether this boot was ever written here, though nothing of it may be left."""
        with in_words(self._path), closing(connect(self._path)) as reader:
            found = reader.execute("SELECT 1 FROM boot WHERE boot_id = ?", (boot_id,))
            return found.fetchone() is not None

    def said_before(self, *channels: Channel) -> Iterator[SaidBefore]:
        """What is kept of these channels of alerts of the boots before this one, newest first.

        Reads while it is iterated.  Damage hides what was said before it in the same boot; what
        earlier boots said is there all the same.
        """
        suffixes = {channel.suffix: channel for channel in channels}
        below, past = self._boot or _NO_BOOT_YET, 1
        with in_words(self._path), closing(connect(self._path)) as reader:
            while below > 0:
                asked = below
                try:
                    for below, suffix, payload in said_before(reader, asked, [*suffixes]):
                        yield SaidBefore(below, suffixes[suffix], payload)
                except sqlite3.Error as error:
                    if code_of(error) not in DAMAGE:
                        raise
                    if below < asked:
                        logger.warning("the journal is damaged at start %d: %s", below, error)
                        past = 1
                    else:
                        below, past = below - past, 2 * past
                else:
                    return

    def acknowledge(self, boot_id: int, to_seq: int) -> None:
        """The station has everything of this boot up to ``to_seq`` on its own disk.

        Of what is still to come it can have nothing, whatever it says.
        """
        if boot_id == self.boot_id:
            to_seq = min(to_seq, self.last_seq)
        with in_words(self._path), self._soon_alone(), self._writer:
            self._writer.execute(
                "UPDATE boot SET acknowledged_seq = MAX(acknowledged_seq, ?) WHERE boot_id = ?",
                (to_seq, boot_id),
            )
            if boot_id == self.boot_id:
                self._acknowledged_seq = max(self._acknowledged_seq, to_seq)

    def close(self) -> None:
        """What was appended is safe already; a disk that hangs is left to the end of the process.

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
    def _soon_alone(self) -> Iterator[None]:
        """With the lock: who waits for a disk that hangs in another thread answers no question
        meanwhile, though what was written before could be read.
        """
        if not self._lock.acquire(timeout=_PATIENCE_S):
            raise StoreError(f"the journal {self._path} hangs: its disk does not answer")
        try:
            yield
        finally:
            self._lock.release()

    def _insert(self, messages: Sequence[Journaled]) -> None:
        """Room is made before: what is safe must not be said to have failed, and be given again."""
        if bytes_used(self._writer) > self._limit_bytes:
            self._make_room()
        rows = [
            (worth_of(each.channel), self._boot, each.seq, each.channel.suffix, each.t_utc_ns,
             each.payload)
            for each in messages
        ]  # fmt: skip
        with self._writer:
            self._writer.executemany("INSERT INTO message VALUES (?, ?, ?, ?, ?, ?)", rows)
        self.last_seq = max(self.last_seq, *(each.seq for each in messages))

    def _begin_anew(self, damage: str) -> None:
        """Once: a disk that damages the new file as well is not filled with more of them."""
        self.damage = f"the journal is damaged ({damage}); it is left alone, and a new one is begun"
        self.first_seq = self.last_seq + 1
        if self._connection is not None:
            self._connection.close()
            self._connection = None
        self._path = anew(self._path)

    @property
    def _writer(self) -> sqlite3.Connection:
        """Of a boot that has begun; for one thread at a time."""
        if self._connection is None and not self._begin_boot():
            raise StoreError(f"the journal {self._path} has another boot {self.boot_id:x}")
        assert self._connection is not None
        return self._connection

    def _begin_boot(self) -> bool:
        """Whether no earlier boot had this one's id."""
        connection = connect(self._path)
        with ExitStack() as in_trouble:
            in_trouble.callback(connection.close)
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
            in_trouble.pop_all()
        return True

    def _make_room(self) -> None:
        self.rows_freed += make_room(self._writer, self._limit_bytes)
        kept = bounds(self._writer, self._boot)
        self.first_seq = self.last_seq + 1 if kept is None else kept[0]


def open_spool(
    path: Path, new_boot_id: Callable[[], int], started_utc_ns: int, limit_bytes: int
) -> tuple[Spool, Path | None]:
    """Open the journal; one that is damaged, or was when it was last used, is set aside under the
    name that is returned.
    """
    aside = path.with_name(f"{path.name}.damaged-{started_utc_ns}")
    with in_words(path):
        is_followed = anew(path).exists()
        if is_followed:
            if path.exists():  # else the power went while they were renamed: what is there is new
                rename(path, aside)
            rename(anew(path), path)
    try:
        spool = Spool(path, new_boot_id, started_utc_ns, limit_bytes)
    except StoreError as error:
        if not is_no_journal(error.__cause__):
            raise
    else:
        return spool, aside if is_followed else None
    with in_words(path):
        rename(path, aside)
    return Spool(path, new_boot_id, started_utc_ns, limit_bytes), aside
