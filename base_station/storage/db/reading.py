"""Reading of a database without any change in its folder.

SQLite puts the index of its WAL beside a database that it reads, and leaves it there; in a folder
without write permission it cannot read it at all.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from shared.errors import StoreError
from shared.folder_lock import FolderLock
from shared.own_files import read_own, write_own

_TRIES = 5  # a command beside the station may be writing
_WITH_WAL = ("", "-wal")  # files of a database: a kill leaves changes in the second one


@contextmanager
def reading(path: Path) -> Iterator[sqlite3.Connection]:
    """Raises sqlite3.Error, or StoreError where it cannot be copied."""
    if FolderLock.is_held(path.parent):  # open in a station, with its journal files
        with closing(connected(path, "mode=ro")) as connection:
            yield connection
        return
    if not _size(beside(path, "-wal")):
        with closing(connected(path, "mode=ro&immutable=1")) as connection:
            yield connection
        return
    with TemporaryDirectory(prefix="muster-database-") as scratch:
        copy = Path(scratch) / path.name
        copy_files(path, copy)
        with closing(sqlite3.connect(copy)) as connection:
            yield connection


def copy_files(source: Path, target: Path) -> None:
    """As it stood at one time.  Raises StoreError where that cannot be."""
    try:
        for _ in range(_TRIES):
            before = _stamps(source)
            for suffix in _WITH_WAL:
                if beside(source, suffix).exists():
                    _copy_file(beside(source, suffix), beside(target, suffix))
            if _stamps(source) == before:
                return
    except OSError as error:
        raise StoreError(f"{source} cannot be copied to {target}: {error.strerror}") from error
    raise StoreError(f"{source} changes all the time: see who writes to it, and try again")


def _copy_file(source: Path, target: Path) -> None:
    with read_own(source) as original, write_own(target, 0o600) as copy:
        shutil.copyfileobj(original, copy)


def _stamps(path: Path) -> list[tuple[int, int]]:
    files = [beside(path, suffix) for suffix in _WITH_WAL]
    return [(file.stat().st_mtime_ns, file.stat().st_size) for file in files if file.exists()]


def _size(path: Path) -> int:
    return path.stat().st_size if path.exists() else 0


def beside(path: Path, suffix: str) -> Path:
    """Return the path of a file that SQLite puts beside a database."""
    return path.with_name(path.name + suffix)


def connected(path: Path, how: str) -> sqlite3.Connection:
    return sqlite3.connect(f"{path.absolute().as_uri()}?{how}", uri=True)
