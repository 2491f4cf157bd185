"""Engines for SQLite: of the file on the disk, and of a database in memory.

SQLite in WAL mode: any number of readers beside one writer.  ``synchronous=FULL`` makes what
was committed survive a power cut.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from sqlalchemy import URL, Connection, Engine, QueuePool, create_engine, event

from shared.own_files import open_own

BUSY_TIMEOUT_S = 10.0  # another process (``muster base users add``) may be writing
DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
NO_ROOM = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR)
NOT_OURS = (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY)

_BEGIN = "muster_begin"
_CHANGES = "muster_changes"
_CHANGING = ("INSERT", "UPDATE", "DELETE", "REPLACE")
_PRAGMAS = (
    "journal_mode = WAL",
    "synchronous = FULL",
    "foreign_keys = ON",
    "secure_delete = ON",  # deleted data is overwritten
)


class Statement(NamedTuple):
    """One statement of a transaction, to be executed again elsewhere."""

    statement: str
    parameters: Any
    is_many: bool

    def execute(self, connection: Connection) -> None:
        cursor = connection.connection.cursor()
        execute = cursor.executemany if self.is_many else cursor.execute
        execute(self.statement, self.parameters)


def file_engine(path: Path) -> Engine:
    where = URL.create("sqlite", database=str(path))
    engine = create_engine(where, connect_args={"timeout": BUSY_TIMEOUT_S})
    return _configured(engine, _PRAGMAS)


def memory_engine(connect: Callable[[], sqlite3.Connection]) -> Engine:
    """``connect`` opens the same database in memory each time."""
    engine = create_engine("sqlite://", creator=connect, poolclass=QueuePool)
    return _configured(engine, ("foreign_keys = ON", "temp_store = MEMORY"))


def writing(engine: Engine, changes: list[Statement]) -> Engine:
    """An engine whose transactions wait for each other; what they change is noted in
    ``changes``.
    """
    return engine.execution_options(**{_BEGIN: "BEGIN IMMEDIATE", _CHANGES: changes})


def make_private(path: Path) -> None:
    """Create an empty private file where there is no database yet; SQLite gives its mode and owner
    to the files beside it.
    """
    with suppress(OSError):  # it is there; or SQLite gives the reason in a moment
        os.close(open_own(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))


def code_of(error: BaseException) -> int:
    """SQLite's primary result code; 0 where the error is not SQLite's own."""
    return int(getattr(error, "sqlite_errorcode", 0)) & 0xFF


def _configured(engine: Engine, pragmas: tuple[str, ...]) -> Engine:
    @event.listens_for(engine, "connect")
    def configure(connection: Any, _record: object) -> None:
        # The driver must not begin transactions by itself: ``begin`` below does.
        connection.isolation_level = None
        for pragma in pragmas:
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql(connection.get_execution_options().get(_BEGIN, "BEGIN"))

    @event.listens_for(engine, "before_cursor_execute")
    def note(
        connection: Connection,
        _cursor: object,
        statement: str,
        parameters: Any,
        _context: object,
        executemany: bool,  # SQLAlchemy's signature
    ) -> None:
        changes = connection.get_execution_options().get(_CHANGES)
        if changes is not None and statement.lstrip()[:7].upper().startswith(_CHANGING):
            # ``executemany`` is also true of many rows in one statement: one row of parameters.
            is_many = executemany and isinstance(parameters[0], tuple | dict | list)
            changes.append(Statement(statement, parameters, is_many))

    return engine
