"""Sets a damaged database aside, and keeps what can be read of what the log does not have.

The damaged file stays beside the new one under a name with the time.  Cut short at any instant, the
next start goes on: the new file is whole before the damaged one is renamed.
"""

from __future__ import annotations

import os
import sqlite3
import time
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from base_station.storage.db.copying import copy_tables, reading_on_full_disk
from base_station.storage.db.engines import DAMAGE, code_of
from base_station.storage.db.models import PROJECTIONS, Base, IncidentTrails, TrackPoint
from base_station.storage.db.reading import beside
from base_station.storage.db.store import Store
from shared.durable_names import sync_folder
from shared.errors import StoreError

CHECK_S = 0.5  # for the tables that grow without end
_SALVAGED = ".salvaged"
_DAMAGED = ".damaged-"
_STEPS = 10_000  # of SQLite's machine, between two looks at the clock
_LARGE = (TrackPoint.__tablename__, IncidentTrails.__tablename__)
_PROJECTED = {table.__tablename__ for table in PROJECTIONS}
_OF_USERS = ("sessions", "hand_overs", "api_tokens")  # without users they are of no use
ONLY_HERE = {
    "users": "users and their passwords",
    "api_tokens": "API tokens",
    "sessions": "logins",
    "people": "the roster of people and their photos",
    "base_map": "the base map",
    "audit": "the audit of logins and of changes to users and people",
}
HOW_TO_GET_BACK = (
    "stop the station and put station.sqlite back from a backup, or enter them anew; where there "
    "is no user left, the administrator has a new password, which is in first-login.txt in the "
    "station's folder"
)
GONE = (
    "The database was gone or empty and has been made again from the log; "
    f"{', '.join(ONLY_HERE.values())} are lost: {HOW_TO_GET_BACK}"
)


@dataclass(frozen=True)
class Salvage:
    """Result for a damaged database: the file set aside, what was copied, what was lost."""

    aside: Path
    damage: str
    lost: tuple[str, ...]  # tables that are nowhere else

    def __str__(self) -> str:
        lost = ", ".join(words for table, words in ONLY_HERE.items() if table in self.lost)
        kept = f"{lost} are lost: {HOW_TO_GET_BACK}" if lost else "users and people were kept"
        return (
            f"The database was damaged ({self.damage}) and has been made again from the log; "
            f"{kept}. The damaged file is {self.aside.name}; check the disk"
        )


def salvage_if_damaged(path: Path, patience_s: float = CHECK_S) -> Salvage | None:
    """None where nothing is wrong with it, or the disk does not let anybody tell.

    ``patience_s``: how long the large tables are checked; what is wrong behind that is found by
    who reads it.  Raises StoreError where the disk does not take the new file.
    """
    salvaged = beside(path, _SALVAGED)
    try:
        if salvaged.exists():
            if not path.exists():  # it ended between its two renamings
                salvaged.replace(path)
            salvaged.unlink(missing_ok=True)
        if not path.is_file() or path.stat().st_size == 0:
            return None
        damage = damage_of(path, patience_s)
        return _set_aside(path, salvaged, damage) if damage else None
    except OSError as error:
        raise StoreError(
            f"{path} is damaged and cannot be made again ({error.strerror}): free or mend the disk"
        ) from error


def remove_damaged(path: Path) -> int:
    """Remove what was set aside of this database; the number of files."""
    aside = list(path.parent.glob(f"{path.name}{_DAMAGED}*"))
    for file in aside:
        file.unlink()
    return len(aside)


def damage_of(path: Path, patience_s: float = CHECK_S) -> str:
    """In words; empty: none was found."""
    try:
        with reading_on_full_disk(path) as reading:
            return _damage_in(reading, patience_s)
    except sqlite3.Error as error:
        return str(error) if code_of(error) in DAMAGE else ""
    except (OSError, StoreError):
        return ""


def _damage_in(reading: sqlite3.Connection, patience_s: float) -> str:
    tables = reading.execute(
        "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%'"
    ).fetchall()
    for (table,) in sorted(tables, key=lambda row: row[0] in _LARGE):
        if table in _LARGE:
            end_s = time.monotonic() + patience_s
            reading.set_progress_handler(lambda: time.monotonic() > end_s, _STEPS)  # noqa: B023  # it is called in this turn alone
        try:
            found = reading.execute(f"PRAGMA quick_check('{table}')").fetchone()[0]
        except sqlite3.Error as error:
            if code_of(error) == sqlite3.SQLITE_INTERRUPT:
                continue  # what is wrong behind is found by who reads it
            if code_of(error) not in DAMAGE:
                raise
            found = str(error)
        if found != "ok":
            return f"{table}: {found.splitlines()[0]}"
    return ""


def _set_aside(path: Path, salvaged: Path, damage: str) -> Salvage:
    with Store(salvaged):
        pass
    lost = _copy_readable(path, salvaged)
    for suffix in ("-wal", "-shm"):
        beside(salvaged, suffix).unlink(missing_ok=True)
    with salvaged.open("rb") as written:
        os.fsync(written.fileno())
    aside = _free_name(path)
    for suffix in ("", "-wal"):
        part = beside(path, suffix)
        if part.exists() and part.stat().st_size:
            part.rename(beside(aside, suffix))
    for suffix in ("-wal", "-shm"):
        beside(path, suffix).unlink(missing_ok=True)
    salvaged.replace(path)
    sync_folder(path.parent)
    return Salvage(aside, damage, tuple(sorted(lost)))


def _copy_readable(path: Path, salvaged: Path) -> set[str]:
    """Gives the tables that are nowhere else and cannot be read."""
    tables = [name for name in Base.metadata.tables if name not in _PROJECTED]
    with closing(sqlite3.connect(salvaged)) as writing:
        try:
            with reading_on_full_disk(path) as reading:
                lost = set(copy_tables(reading, writing, tables))
        except (sqlite3.Error, OSError, StoreError):
            lost = set(tables)
        if "users" in lost:
            lost.update(_OF_USERS)
        for table in _OF_USERS if "users" in lost else ():
            writing.execute(f"DELETE FROM {table}")  # noqa: S608  # names of our own tables
        writing.commit()
        writing.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        return lost


def _free_name(path: Path) -> Path:
    at = datetime.now(UTC)
    name = beside(path, f"{_DAMAGED}{at:%Y%m%dT%H%M%SZ}")
    number = 1
    while name.exists():
        number += 1
        name = beside(path, f"{_DAMAGED}{at:%Y%m%dT%H%M%SZ}-{number}")
    return name
