"""A damaged database file: its readable rows, and the name under which it is set aside.

The whole new file is there under ``SALVAGED`` before the damaged one gets its other name: a start
after a kill between the two goes on with it.
"""

from __future__ import annotations

import sqlite3
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path

from base_station.storage.db.copying import copy_tables, reading_on_full_disk
from base_station.storage.db.models import PROJECTIONS, Base
from base_station.storage.db.reading import beside
from shared.errors import StoreError

SALVAGED = ".salvaged"
_DAMAGED = ".damaged-"
_PROJECTED = {table.__tablename__ for table in PROJECTIONS}
_OF_USERS = ("sessions", "hand_overs", "api_tokens")  # without users they are of no use


def copy_readable(path: Path, target: sqlite3.Connection) -> tuple[str, ...]:
    """Copy the rows that the log does not have; returns the tables that cannot be read.

    Raises sqlite3.Error where ``target`` does not take them.
    """
    tables = [name for name in Base.metadata.tables if name not in _PROJECTED]
    with ExitStack() as closing:
        try:
            reading = closing.enter_context(reading_on_full_disk(path))
        except (sqlite3.Error, OSError, StoreError):
            lost = set(tables)
        else:
            lost = set(copy_tables(reading, target, tables))
    if "users" in lost:
        lost.update(_OF_USERS)
        for table in _OF_USERS:
            target.execute(f"DELETE FROM {table}")  # noqa: S608  # names of our own tables
    target.commit()
    return tuple(sorted(lost))


def set_aside(path: Path) -> Path:
    """Rename the damaged file, and return its new name."""
    aside = _free_name(path)
    for suffix in ("", "-wal"):
        part = beside(path, suffix)
        if part.exists() and part.stat().st_size:
            part.rename(beside(aside, suffix))
    for suffix in ("-wal", "-shm"):
        beside(path, suffix).unlink(missing_ok=True)
    return aside


def remove_damaged(path: Path) -> int:
    """Remove the damaged files that were set aside; returns their number."""
    aside = list(path.parent.glob(f"{path.name}{_DAMAGED}*"))
    for file in aside:
        file.unlink()
    return len(aside)


def _free_name(path: Path) -> Path:
    at = datetime.now(UTC)
    name = beside(path, f"{_DAMAGED}{at:%Y%m%dT%H%M%SZ}")
    number = 1
    while name.exists():
        number += 1
        name = beside(path, f"{_DAMAGED}{at:%Y%m%dT%H%M%SZ}-{number}")
    return name
