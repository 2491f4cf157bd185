"""Opens the database, and gives out sessions that read or write.

SQLite in WAL mode: any number of readers beside one writer.  ``synchronous=FULL`` makes what
was committed survive a power cut.
"""

from __future__ import annotations

import os
import shutil
import sqlite3
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from base_station.db.migrate import migrate
from shared.errors import DiskHangsError, StoreError
from shared.own_files import open_own

BUSY_TIMEOUT_S = 10.0  # another process (``muster base users add``) may be writing
_LOOK_S = 0.5  # whether the disk hangs, while another change is waited for
_BEGIN = "muster_begin"
_PRAGMAS = (
    "journal_mode = WAL",
    "synchronous = FULL",
    "foreign_keys = ON",
    "secure_delete = ON",  # what is deleted is overwritten
)
_DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_NO_ROOM = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR)
_NOT_OURS = (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY)


class Store:
    """The database of one data folder, migrated to what this program knows.

    Thread-safe.  Raises StoreError where the file is no database, cannot be written, or was
    written by a newer program.
    """

    def __init__(self, path: Path, hangs: Callable[[], bool] = lambda: False) -> None:
        """``hangs``: whether the disk does not answer just now.  Nothing more is asked of it then:
        whoever does would wait for it, whatever else there is to do, and could not be ended.
        """
        self.hangs = hangs
        _make_private(path)
        self._engine = _engine(path)
        self._write_engine = self._engine.execution_options(**{_BEGIN: "BEGIN IMMEDIATE"})
        self._writing = threading.Lock()
        try:
            migrate(self._engine)
        except SQLAlchemyError as error:
            self._engine.dispose()
            raise StoreError(
                f"{path} cannot be opened as the station's database: {self._cause(error)}"
            ) from error
        except StoreError:
            self._engine.dispose()
            raise

    @property
    def engine(self) -> Engine:
        return self._engine

    @contextmanager
    def read(self) -> Iterator[Session]:
        """A consistent view for one reader.  Raises StoreError where the file cannot be read."""
        self._require_disk()
        try:
            with Session(self._engine, expire_on_commit=False) as session:
                yield session
        except SQLAlchemyError as error:
            raise StoreError(f"the database cannot be read: {self._cause(error)}") from error

    @contextmanager
    def write(self) -> Iterator[Session]:
        """One transaction, committed at the end of the block; one at a time.

        Raises StoreError where the database cannot take it (a full disk, a locked file).
        """
        with self._alone():
            try:
                with Session(self._write_engine, expire_on_commit=False) as session:
                    yield session
                    session.commit()
            except SQLAlchemyError as error:
                cause = self._cause(error)
                raise StoreError(f"the database did not take a change: {cause}") from error

    def compact(self) -> None:
        """Leave no byte in the file of what was deleted or replaced."""
        with self._alone():
            connection = self._engine.raw_connection()
            try:
                for statement in ("VACUUM", "PRAGMA wal_checkpoint(TRUNCATE)"):
                    connection.cursor().execute(statement)
            except sqlite3.Error as error:
                raise StoreError(f"the database cannot be made compact: {error}") from error
            finally:
                connection.close()

    def close(self) -> None:
        self._engine.dispose()

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Nobody else changes anything."""
        self._require_disk()
        while not self._writing.acquire(timeout=_LOOK_S):
            self._require_disk()
        try:
            yield
        finally:
            self._writing.release()

    def _require_disk(self) -> None:
        if self.hangs():
            raise DiskHangsError(
                "the station's disk does not answer: until it does nothing can be looked up or "
                "kept in the database; people are shown and commanded as before; check the disk"
            )

    def _cause(self, error: SQLAlchemyError) -> str:
        cause = getattr(error, "orig", None) or error
        code = _code_of(cause)
        if code in _DAMAGE:
            return (
                f"{cause}; stop the station, and put {self._engine.url.database} back from a "
                "backup or move it away: what the log knows is made again at the next start, "
                "people and users are not"
            )
        if code in _NO_ROOM:
            return f"{cause}; free or mend the disk"
        remedy = "; see that file and folder can be written" if code in _NOT_OURS else ""
        return f"{cause}{remedy}"

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _make_private(path: Path) -> None:
    """Where there is no database yet; what SQLite puts beside one has its mode and owner."""
    with suppress(OSError):  # it is there; or SQLite says in a moment why it cannot be
        os.close(open_own(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))


def copy_database(source: Path, target: Path) -> None:
    """Copy a database that a running station may be writing to; without one, do nothing.

    Raises StoreError where it cannot be read or ``target`` not be written.
    """
    if not source.exists():
        return
    try:
        with (
            closing(_reading(source)) as reading,
            closing(sqlite3.connect(target)) as writing,
        ):
            reading.backup(writing)
    except sqlite3.Error as error:
        if _code_of(error) in _NOT_OURS and not _beside(source, "-shm").exists():
            _copy_files(source, target)  # nobody has it open, and SQLite could not put that there
            return
        if _code_of(error) in _NO_ROOM:
            raise StoreError(
                f"{source} cannot be copied ({error}): see that there is room beside {target}"
            ) from error
        raise StoreError(f"{source} cannot be read as the station's database: {error}") from error


def _copy_files(source: Path, target: Path) -> None:
    """With what a kill left of changes beside it."""
    try:
        for suffix in ("", "-wal"):
            if (path := _beside(source, suffix)).exists():
                shutil.copyfile(path, _beside(target, suffix))
    except OSError as error:
        raise StoreError(f"{source} cannot be copied to {target}: {error.strerror}") from error


def _beside(path: Path, suffix: str) -> Path:
    return path.with_name(path.name + suffix)


def _code_of(error: BaseException) -> int:
    """SQLite's primary result code; 0 where the error is not SQLite's own."""
    return int(getattr(error, "sqlite_errorcode", 0)) & 0xFF


def known_segments(path: Path) -> set[str]:
    """Of which log a copied database tells, by the names of its segments."""
    try:
        with closing(_reading(path)) as reading:
            return {row[0] for row in reading.execute("SELECT name FROM log_segments")}
    except sqlite3.Error:  # there is none, or something else
        return set()


def _reading(path: Path) -> sqlite3.Connection:
    return sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)


def _engine(path: Path) -> Engine:
    where = URL.create("sqlite", database=str(path))
    engine = create_engine(where, connect_args={"timeout": BUSY_TIMEOUT_S})

    @event.listens_for(engine, "connect")
    def configure(connection: Any, _record: object) -> None:
        # The driver must not begin transactions by itself: ``begin`` below says how.
        connection.isolation_level = None
        for pragma in _PRAGMAS:
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql(connection.get_execution_options().get(_BEGIN, "BEGIN"))

    return engine
