"""Database file of the journal: how it is opened, and SQLite's errors of a disk or of damage."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from shared.coded_text import coded
from shared.errors import StoreError

# Of a disk that is full, or has failed and can only be read.
REFUSAL = (
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_CANTOPEN,
)
DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_NO_JOURNAL = (*DAMAGE, sqlite3.SQLITE_ERROR)  # of a file when it is opened


def code_of(error: sqlite3.Error) -> int:
    """Return the kind of an error, without SQLite's extension; 0 of one that is not SQLite's
    own.
    """
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def is_no_journal(error: BaseException | None) -> bool:
    """Return True for the error of a file that is too damaged to be opened."""
    if isinstance(error, UnicodeDecodeError):  # SQLite names what is damaged by the bytes there
        return True
    return isinstance(error, sqlite3.Error) and code_of(error) in _NO_JOURNAL


def connect(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(path, check_same_thread=False, timeout=5.0)
    try:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = FULL")
    except (sqlite3.Error, UnicodeDecodeError):
        connection.close()
        raise
    return connection


@contextmanager
def as_store_error(path: Path) -> Iterator[None]:
    """Raise what goes wrong with the file as a StoreError that names it."""
    try:
        yield
    except (sqlite3.Error, OSError, UnicodeDecodeError) as error:
        raise StoreError(
            coded(
                "journal-unusable",
                "the journal {path} cannot be used: {error}",
                path=str(path),
                error=str(error),
            )
        ) from error


def replacement_of(path: Path) -> Path:
    """Return the path of the file that replaces the one at ``path`` when that is damaged."""
    return path.with_name(f"{path.name}.anew")


def rename(path: Path, to: Path) -> None:
    """Rename the file with what SQLite keeps beside it."""
    for tail in ("-wal", "-shm", ""):
        part = path.with_name(path.name + tail)
        if part.exists():
            part.rename(to.with_name(to.name + tail))
