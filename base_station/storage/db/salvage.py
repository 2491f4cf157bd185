"""Sets a damaged database aside, and keeps readable rows that the log does not have.

The damaged file stays beside the new one under a name with the time.  After a kill at any instant
the next start continues: the new file is complete before the damaged one is renamed.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Callable, Collection
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path

from base_station.storage.db.copying import reading_on_full_disk
from base_station.storage.db.damaged_file import SALVAGED, copy_readable, set_aside
from base_station.storage.db.engines import DAMAGE, code_of
from base_station.storage.db.models import IncidentTrails, TrackPoint
from base_station.storage.db.reading import beside
from base_station.storage.db.store import Store
from shared.coded_text import coded
from shared.durable_names import sync_folder
from shared.errors import DiskFullError, StoreError

CHECK_S = 0.5  # for the tables that grow without end
_STEPS = 10_000  # of SQLite's virtual machine, between two checks of the clock
_LARGE = (TrackPoint.__tablename__, IncidentTrails.__tablename__)
ONLY_HERE = {
    "users": "users and their passwords",
    "api_tokens": "API tokens",
    "sessions": "logins",
    "people": "the roster: people's names, crews and photos, of which the log has the ids alone",
    "base_map": "the base map",
    "audit": "the audit of logins and of changes to users and people",
}
_COPIED = ("users", "api_tokens", "people", "base_map")  # which the other station of two has too
_BY_HAND = (
    "stop the station and put station.sqlite back from a backup, or enter them anew; where there "
    "is no user left, the administrator has a new password, which is in first-login.txt in the "
    "station's folder"
)
_FROM_THE_OTHER = (
    "of two stations the other one has users, tokens, people and the base map too, and they come "
    "back when it is reachable; else"
)


def loss_of(tables: Collection[str], *, alone: bool) -> str:
    """Loss of a database that was made again, and what to do, in words.  ``alone``: there is no
    other station that has a copy.
    """
    lost = ", ".join(words for table, words in ONLY_HERE.items() if table in tables)
    from_other = "" if alone or not set(_COPIED) & set(tables) else f"{_FROM_THE_OTHER} "
    return f"{lost} are lost: {from_other}{_BY_HAND}"


def gone(*, alone: bool) -> str:
    """As ``Salvage.described``, of a file that is not there."""
    lost = loss_of(ONLY_HERE, alone=alone)
    return coded(
        "database-gone",
        "The database was gone or empty and has been made again from the log; {loss}",
        loss=lost,
    )


@dataclass(frozen=True)
class Salvage:
    """Result for a damaged database: the file set aside, the copied tables, and the losses."""

    aside: Path | None  # None: it stays where it is until the disk takes another
    damage: str
    lost: tuple[str, ...]  # tables that are nowhere else

    def described(self, *, alone: bool) -> str:
        kept = loss_of(self.lost, alone=alone) if self.lost else "users and people were kept"
        file = (
            f"The damaged file is {self.aside.name}"
            if self.aside is not None
            else "The damaged file is kept, and set aside when there is room for another"
        )
        return coded(
            "database-made-again",
            "The database was damaged ({damage}) and has been made again from the log; {loss}. "
            "{file}; check the disk",
            damage=self.damage,
            loss=kept,
            file=file,
        )


def open_live(path: Path, hangs: Callable[[], bool]) -> tuple[Store, Salvage | None]:
    """A live station's database, made again where it was damaged: in memory where the disk does not
    take a new file, beside the damaged one until it does.
    """
    try:
        salvage = salvage_if_damaged(path)
    except DiskFullError as error:
        store = Store(path, hangs, memory_fallback=True, no_room_beside_damaged=str(error))
        return store, Salvage(None, damage_of(path), store.unreadable)
    return Store(path, hangs, memory_fallback=True), salvage


def salvage_if_damaged(path: Path, patience_s: float = CHECK_S) -> Salvage | None:
    """Make a damaged database again.  None: it is whole, or the disk does not let it be checked.

    ``patience_s``: how long the large tables are checked; damage behind that is found when it is
    read.  Raises DiskFullError where the disk does not take the new file.
    """
    salvaged = beside(path, SALVAGED)
    try:
        if salvaged.exists():
            if not path.exists():  # it ended between its two renamings
                salvaged.replace(path)
            salvaged.unlink(missing_ok=True)
        if not path.is_file() or path.stat().st_size == 0:
            return None
        damage = damage_of(path, patience_s)
        return _make_again(path, salvaged, damage) if damage else None
    except (DiskFullError, OSError) as error:
        raise DiskFullError(
            f"{path} is damaged and cannot be made again ({error}): free or mend the disk"
        ) from error


def damage_of(path: Path, patience_s: float = CHECK_S) -> str:
    """Return the damage in words; empty: none was found."""
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
                continue  # damage behind that is found when it is read
            if code_of(error) not in DAMAGE:
                raise
            found = str(error)
        if found != "ok":
            return f"{table}: {found.splitlines()[0]}"
    return ""


def _make_again(path: Path, salvaged: Path, damage: str) -> Salvage:
    """Raises DiskFullError where there is no room for the new file, which then leaves nothing."""
    try:
        with Store(salvaged):
            pass
        with closing(sqlite3.connect(salvaged)) as writing:
            lost = copy_readable(path, writing)
            writing.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        with salvaged.open("rb") as written:
            os.fsync(written.fileno())
    except (DiskFullError, sqlite3.Error, OSError) as error:
        for suffix in ("", "-wal", "-shm"):
            with suppress(OSError):
                beside(salvaged, suffix).unlink(missing_ok=True)
        raise DiskFullError(str(error)) from error
    for suffix in ("-wal", "-shm"):
        beside(salvaged, suffix).unlink(missing_ok=True)
    aside = set_aside(path)
    salvaged.replace(path)
    sync_folder(path.parent)
    return Salvage(aside, damage, lost)
