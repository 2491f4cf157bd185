"""The journal's file: how it is opened, and what SQLite says of a disk or of damage."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

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
    """The kind of an error, without what SQLite adds to it; 0 of one that is not SQLite's own."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def is_no_journal(error: BaseException | None) -> bool:
    """Of a file that could not be opened: whether it is too damaged for that."""
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
def in_words(path: Path) -> Iterator[None]:
    """What goes wrong with the file is a StoreError that names it."""
    try:
        yield
    except (sqlite3.Error, OSError, UnicodeDecodeError) as error:
        raise StoreError(f"the journal {path} cannot be used: {error}") from error


def anew(path: Path) -> Path:
    """The file that is begun where the one at ``path`` turns out to be damaged."""
    return path.with_name(f"{path.name}.anew")


def rename(path: Path, to: Path) -> None:
    """With what SQLite keeps beside it, as far as there is any of it."""
    for tail in ("-wal", "-shm", ""):
        part = path.with_name(path.name + tail)
        if part.exists():
            part.rename(to.with_name(to.name + tail))
