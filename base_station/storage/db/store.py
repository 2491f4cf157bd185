"""Database in a file, with sessions that read or write.  While the disk cannot be written, a live
station works on a copy in memory (``memory_copy``).
"""

from __future__ import annotations

import logging
import shutil
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from base_station.storage.db.damaged_file import remove_damaged
from base_station.storage.db.database import IN_MEMORY
from base_station.storage.db.engines import (
    DAMAGE,
    NO_ROOM,
    NOT_OURS,
    Statement,
    code_of,
    file_engine,
    make_private,
    writing,
)
from base_station.storage.db.memory_copy import MemoryCopy
from base_station.storage.db.migrate import migrate
from shared.coded_text import coded, join_texts
from shared.errors import DiskFullError, DiskHangsError, StoreError

_log = logging.getLogger(__name__)

_LOOK_S = 0.5  # between two checks for a hanging disk, while waiting for another writer
_RETRY_S = 2.0  # between two attempts to write to a disk that failed
_ROOM_BYTES = 4_000_000  # with less the next changes would fill it again
_CAN_BE_READ = (*NO_ROOM, *NOT_OURS)  # though it cannot be written


class Store:
    """The database of one data folder, migrated to what this program knows.

    Thread-safe.  Raises StoreError where the file is no database, cannot be written, or was
    written by a newer program.
    """

    def __init__(
        self,
        path: Path,
        hangs: Callable[[], bool] = lambda: False,
        *,
        memory_fallback: bool = False,
        no_room_beside_damaged: str = "",
    ) -> None:
        """``hangs``: whether the disk does not answer just now.  It is not used then: a caller
        would wait for it, whatever else there is to do, and could not be ended.

        ``memory_fallback``: a disk that takes nothing does not keep it from opening.
        ``no_room_beside_damaged``: why the disk takes no other file in place of this one, which is
        damaged; it stays as it is until there is room.
        """
        self.hangs = hangs
        self.path = path
        self._memory_fallback = memory_fallback
        self._writing = threading.Lock()
        self._memory: MemoryCopy | None = None
        self._tried_s = 0.0
        self._refused = 0
        self.loss: str = ""  # missing data since it was made again, as a sentence for a person
        self._damage = ""  # that was met since
        self._reason = no_room_beside_damaged  # why the disk takes nothing
        if no_room_beside_damaged:
            self._go_into_memory(is_open=False, is_damaged=True)
            return
        try:
            self._engine = self._opened()
        except DiskFullError:
            if not memory_fallback:
                raise
            self._go_into_memory(is_open=False)

    @property
    def engine(self) -> Engine:
        return self._engine

    @property
    def name(self) -> str:
        return str(self.path)

    @property
    def is_away(self) -> bool:
        """True if its disk does not answer."""
        return self.hangs()

    @property
    def unreadable(self) -> tuple[str, ...]:
        """Tables of the damaged file that cannot be restored, while it is kept in memory."""
        return self._memory.unreadable if self._memory is not None else ()

    @property
    def in_memory(self) -> bool:
        """True if the disk cannot be written: changes are in memory and wait for it."""
        return self._memory is not None

    @property
    def problem(self) -> str:
        """Problem of the database, as a sentence for a person; empty: none."""
        damage = self._damage and coded(
            "database-damaged", "The database is damaged: {damage}", damage=self._damage
        )
        return join_texts((damage, self._disk_problem, self.loss))

    @property
    def _disk_problem(self) -> str:
        memory = self._memory
        if memory is not None:
            if memory.lacks_tracks:
                return coded(
                    "database-in-memory-without-trails",
                    "The database is kept in memory, as its disk takes nothing: what is changed "
                    "is written when it does, and lost if the station stops before; trails of "
                    "past incidents cannot be shown; {reason}",
                    reason=self._reason,
                )
            return coded(
                "database-in-memory",
                "The database is kept in memory, as its disk takes nothing: what is changed is "
                "written when it does, and lost if the station stops before; {reason}",
                reason=self._reason,
            )
        if self._refused:
            return coded(
                "database-changes-refused",
                "{count} changes that were made while the disk took nothing are not in the "
                "database, as others were made there meanwhile: look through users and people",
                count=self._refused,
            )
        return ""

    @contextmanager
    def read(self) -> Iterator[Session]:
        """A consistent view for one reader.  Raises StoreError where the file cannot be read."""
        self._require_disk()
        try:
            with self._readable() as engine, Session(engine, expire_on_commit=False) as session:
                yield session
        except SQLAlchemyError as error:
            raise StoreError(f"the database cannot be read: {self._cause(error)}") from error

    @contextmanager
    def write(self, *, is_kept: bool = True) -> Iterator[Session]:
        """One transaction, committed at the end of the block; one at a time.  What is not
        ``is_kept`` while the disk takes nothing is done again by the caller.

        Raises StoreError where the database cannot take it (a full disk, a locked file).
        """
        with self._alone():
            self._leave_memory_if_due()
            session, changes = self._begun()
            with closing(session):
                try:
                    yield session
                except SQLAlchemyError as error:
                    raise self._not_taken(error) from error
                try:
                    session.commit()
                except SQLAlchemyError as error:
                    self._commit_in_memory(error, changes)
            session.info[IN_MEMORY] = self.in_memory
            if self._memory is not None and is_kept:
                self._memory.keep(changes)

    def check_disk(self) -> None:
        """Return to the file if its disk can be written again."""
        if self.in_memory:
            with suppress(DiskHangsError), self._alone():
                self._leave_memory_if_due()

    def compact(self) -> int:
        """Leave no byte in the file of what was deleted or replaced, and no damaged file of before;
        gives the number of these.
        """
        with self._alone():
            if self.in_memory:
                raise DiskFullError(f"the database cannot be made compact: {self._reason}")
            connection = self._engine.raw_connection()
            try:
                for statement in ("VACUUM", "PRAGMA wal_checkpoint(TRUNCATE)"):
                    connection.cursor().execute(statement)
            except sqlite3.Error as error:
                raise StoreError(f"the database cannot be made compact: {error}") from error
            finally:
                connection.close()
        return remove_damaged(self.path)

    def close(self) -> None:
        if self._memory is not None:
            with suppress(StoreError), self._alone():
                self._tried_s = 0.0
                self._leave_memory_if_due()
        if self._memory is not None:
            _log.error(
                "%d changes of the database are lost: its disk took nothing until the end",
                self._memory.waiting,
            )
            self._memory.close()
        self._engine.dispose()

    # ---- on the disk or in memory

    @contextmanager
    def _readable(self) -> Iterator[Engine]:
        """Return the database for one reader, who stays on the copy in memory until done."""
        memory = self._memory
        if memory is not None:
            with memory.kept_open() as is_open:
                if is_open:
                    yield memory.engine
                    return
        yield self._engine

    def _opened(self) -> Engine:
        """The file.  Raises StoreError."""
        _refuse_link(self.path)
        make_private(self.path)
        engine = file_engine(self.path)
        try:
            migrate(engine)
        except SQLAlchemyError as error:
            engine.dispose()
            self._reason = self._cause(error)
            kind = DiskFullError if self._is_readable(error) else StoreError
            raise kind(
                f"{self.path} cannot be opened as the station's database: {self._reason}"
            ) from error
        except StoreError:
            engine.dispose()
            raise
        return engine

    def _is_readable(self, error: SQLAlchemyError) -> bool:
        """True if it failed at a disk that takes nothing, and may give what is there."""
        return code_of(getattr(error, "orig", None) or error) in _CAN_BE_READ and (
            not self.path.exists() or self.path.is_file()
        )

    def _go_into_memory(self, *, is_open: bool, is_damaged: bool = False) -> None:
        self._memory = MemoryCopy(self.path, is_open=is_open, is_damaged=is_damaged)
        self._tried_s = time.monotonic()
        self._engine = self._memory.engine

    def _begun(self) -> tuple[Session, list[Statement]]:
        """A session of the only writer.  Raises StoreError."""
        changes: list[Statement] = []
        session = Session(writing(self._engine, changes), expire_on_commit=False)
        try:
            session.connection()
        except SQLAlchemyError as error:
            session.close()
            refusal = self._not_taken(error)
            if not self.in_memory:
                raise refusal from error
            session = Session(writing(self._engine, changes), expire_on_commit=False)
        if self._memory is not None and self._memory.is_full:
            session.close()
            raise DiskFullError(f"no more changes can wait for the disk: {self._reason}")
        return session, changes

    def _not_taken(self, error: SQLAlchemyError) -> StoreError:
        """Error for a change that was not written; memory replaces a failing disk from now on."""
        cause = self._cause(error)
        if self._memory is None and self._memory_fallback and self._is_readable(error):
            before, self._reason = self._engine, cause
            with suppress(StoreError):
                self._go_into_memory(is_open=True)
                before.dispose()
        return StoreError(f"the database did not take a change: {cause}")

    def _commit_in_memory(self, error: SQLAlchemyError, changes: list[Statement]) -> None:
        """Make in memory the changes that the disk did not take at commit.  Raises StoreError."""
        was_in_memory = self.in_memory
        refusal = self._not_taken(error)
        if was_in_memory or self._memory is None:
            raise refusal from error
        try:
            self._memory.execute(changes)
        except (SQLAlchemyError, sqlite3.Error):
            raise refusal from error

    def _leave_memory_if_due(self) -> None:
        """Return from memory to the disk, if an attempt is due.  The caller is the only writer."""
        memory, now_s = self._memory, time.monotonic()
        if memory is None or now_s - self._tried_s < _RETRY_S or self.hangs():
            return
        self._tried_s = now_s
        try:
            if shutil.disk_usage(self.path.parent).free < _ROOM_BYTES:
                return
            if memory.is_damaged or (memory.is_new and not _has_content(self.path)):
                memory.write_new()
            engine = self._opened()
        except (StoreError, sqlite3.Error, OSError):
            return
        try:
            self._refused += memory.write_to(engine)
        except (SQLAlchemyError, sqlite3.Error):
            engine.dispose()
            return
        self._engine, self._memory = engine, None
        memory.leave()

    # ---- failures

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Hold the lock of the one writer."""
        self._require_disk()
        while not self._writing.acquire(timeout=_LOOK_S):
            self._require_disk()
        try:
            yield
        finally:
            self._writing.release()

    def _require_disk(self) -> None:
        if not self.in_memory and self.hangs():
            raise DiskHangsError(
                "the station's disk does not answer: until it does nothing can be looked up or "
                "kept in the database; people are shown and commanded as before; check the disk"
            )

    def _cause(self, error: SQLAlchemyError) -> str:
        cause = getattr(error, "orig", None) or error
        code = code_of(cause)
        if code in DAMAGE:
            self._damage = (
                f"{cause}; stop the station and run 'muster base rebuild': it makes {self.path} "
                "again from the log, keeps what can be read of users and people, and reports "
                "what cannot; or put it back from a backup"
            )
            return self._damage
        if code in NO_ROOM:
            return f"{cause}; free or mend the disk"
        remedy = "; see that file and folder can be written" if code in NOT_OURS else ""
        return f"{cause}{remedy}"

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _has_content(path: Path) -> bool:
    return path.exists() and path.stat().st_size > 0


def _refuse_link(path: Path) -> None:
    """SQLite follows one; what it puts beside a database it opens without."""
    if path.is_symlink():
        raise StoreError(f"{path} is a link, which is not followed: put the database itself there")
