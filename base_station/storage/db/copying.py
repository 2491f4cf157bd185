"""Copies of a database: into another file, and into memory where the disk cannot be written."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.storage.db.engines import NO_ROOM, NOT_OURS, code_of
from base_station.storage.db.reading import beside, connected, copy_files, reading
from shared.errors import StoreError

_MEMORY_DISK = Path("/dev/shm")  # noqa: S108  # a folder in memory, on Linux


def copy_database(source: Path, target: Path) -> None:
    """Copy a database that a running station may be writing to; without one, do nothing.

    Raises StoreError where it cannot be read or ``target`` not be written.
    """
    if not source.exists():
        return
    try:
        with (
            reading(source) as original,
            closing(sqlite3.connect(target)) as copy,
        ):
            original.backup(copy)
    except sqlite3.Error as error:
        if code_of(error) in NO_ROOM:
            raise StoreError(
                f"{source} cannot be copied ({error}): see that there is room beside {target}"
            ) from error
        raise StoreError(f"{source} cannot be read as the station's database: {error}") from error


def known_segments(path: Path) -> set[str]:
    """Names of the log segments that a copied database lists."""
    try:
        with reading(path) as connection:
            return {row[0] for row in connection.execute("SELECT name FROM log_segments")}
    except (sqlite3.Error, StoreError):  # there is none, or something else
        return set()


@contextmanager
def reading_on_full_disk(path: Path, *, is_open: bool = False) -> Iterator[sqlite3.Connection]:
    """A database beside which the disk may take nothing: SQLite would put the index of its WAL
    there.  ``is_open``: this process has it open, and that is there.  Raises sqlite3.Error, OSError
    or StoreError where it cannot be read.
    """
    with ExitStack() as closing_all:
        yield _readable(path, closing_all, is_open=is_open)


def _readable(path: Path, closing_all: ExitStack, *, is_open: bool) -> sqlite3.Connection:
    try:
        plain = closing(connected(path, "mode=ro")) if is_open else reading(path)
        connection: sqlite3.Connection = closing_all.enter_context(plain)
        connection.execute("SELECT 1 FROM sqlite_master")
        return connection
    except sqlite3.Error as error:
        if code_of(error) not in (*NO_ROOM, *NOT_OURS):
            raise
    except StoreError:  # no room for a copy where such are made
        pass
    wal = beside(path, "-wal")
    if not wal.exists() or wal.stat().st_size == 0:
        return closing_all.enter_context(closing(connected(path, "mode=ro&immutable=1")))
    place = _MEMORY_DISK if _MEMORY_DISK.is_dir() else None
    scratch = closing_all.enter_context(TemporaryDirectory(prefix="muster-", dir=place))
    copy = Path(scratch) / path.name
    copy_files(path, copy)
    return closing_all.enter_context(closing(sqlite3.connect(copy)))


def copy_tables(
    source: sqlite3.Connection, target: sqlite3.Connection, tables: Collection[str]
) -> list[str]:
    """The rows of these tables, in the columns that both have; names those that cannot be read,
    or are nothing that such a table holds: of these nothing is copied.

    Raises sqlite3.Error where ``target`` does not take them.
    """
    unreadable = []
    for table in tables:
        try:
            columns = _columns(source, table) & _columns(target, table)
            names = ", ".join(f'"{column}"' for column in sorted(columns))
            rows = source.execute(f'SELECT {names} FROM "{table}"').fetchall() if columns else []  # noqa: S608  # names of our own tables
        except sqlite3.Error:
            unreadable.append(table)
            continue
        marks = ", ".join("?" * len(columns))
        if rows:
            try:
                target.executemany(f'INSERT INTO "{table}" ({names}) VALUES ({marks})', rows)  # noqa: S608  # as above
            except sqlite3.IntegrityError:
                target.rollback()
                unreadable.append(table)
        target.commit()
    return unreadable


def _columns(connection: sqlite3.Connection, table: str) -> set[str]:
    return {row[1] for row in connection.execute(f'PRAGMA table_info("{table}")')}
