"""Copy of the station's database in memory, while its disk cannot be written.  Its transactions are
recorded, and repeated in the file when the disk can be written again; changes that others made in
the file meanwhile stay.
"""

from __future__ import annotations

import logging
import os
import secrets
import sqlite3
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from threading import Lock

from sqlalchemy import Engine, text
from sqlalchemy.exc import SQLAlchemyError

from base_station.storage.db.copying import copy_tables, reading_on_full_disk
from base_station.storage.db.damaged_file import SALVAGED, copy_readable, set_aside
from base_station.storage.db.engines import (
    BUSY_TIMEOUT_S,
    Statement,
    make_private,
    memory_engine,
    writing,
)
from base_station.storage.db.migrate import migrate
from base_station.storage.db.models import (
    Base,
    IncidentTrails,
    PostProcessingCache,
    SmoothedIncident,
    TrackPoint,
)
from base_station.storage.db.reading import beside
from shared.durable_names import sync_folder
from shared.errors import StoreError

WHOLE_BYTES_MAX = 256_000_000  # of a larger file the tracks are left out
_LARGE: tuple[type[Base], ...] = (TrackPoint, SmoothedIncident, IncidentTrails, PostProcessingCache)
_WAITING_MAX = 20_000  # transactions; a login makes two

_log = logging.getLogger(__name__)


class MemoryCopy:
    """Not thread-safe: one changes it at a time."""

    def __init__(self, path: Path, *, is_open: bool, is_damaged: bool = False) -> None:
        """An empty one where there is no file.  ``is_open``: this process has the file open;
        ``is_damaged``: its readable rows are taken, and all else is to be made again.  Raises
        StoreError where it cannot be read.
        """
        self.is_damaged = is_damaged
        self.is_new = is_damaged or not path.exists() or path.stat().st_size == 0
        self.unreadable: tuple[str, ...] = ()  # tables of a damaged file
        self.lacks_tracks = False
        self._path = path
        self._name = f"file:/muster-{secrets.token_hex(8)}?vfs=memdb"
        self._keeper = self._connect()  # the database is there for as long as one is connected
        self.engine = memory_engine(self._connect)
        self._waiting: list[list[Statement]] = []
        self._readers, self._is_left = 0, False
        self._lock = Lock()
        try:
            if not self.is_new:
                self._fill(is_open=is_open)
            migrate(self.engine)
            if is_damaged:
                self.unreadable = copy_readable(path, self._keeper)
        except (sqlite3.Error, OSError, SQLAlchemyError) as error:
            self.close()
            raise StoreError(f"{path} cannot be read as the station's database: {error}") from error
        except StoreError:
            self.close()
            raise

    @property
    def waiting(self) -> int:
        """Transactions."""
        return len(self._waiting)

    @property
    def is_full(self) -> bool:
        return len(self._waiting) >= _WAITING_MAX

    def keep(self, changes: list[Statement]) -> None:
        """Keep a transaction that was committed here, to repeat it in the file; a file that is made
        anew gets everything.
        """
        if changes and not self.is_new:
            self._waiting.append(changes)

    def execute(self, changes: list[Statement]) -> None:
        """Execute a transaction that the disk did not take.  Raises SQLAlchemyError or
        sqlite3.Error.
        """
        with writing(self.engine, []).begin() as connection:
            for change in changes:
                change.execute(connection)

    def write_to(self, engine: Engine) -> int:
        """Repeat the waiting transactions in the file, all or nothing; returns the number that it
        refused, because of other changes there.  Raises SQLAlchemyError or sqlite3.Error.
        """
        refused = 0
        with writing(engine, []).begin() as connection:
            # The test that the disk can be written is needed also where nothing waits.
            connection.execute(text("PRAGMA user_version = 0"))
            for changes in self._waiting:
                try:
                    with connection.begin_nested():
                        for change in changes:
                            change.execute(connection)
                except (sqlite3.IntegrityError, SQLAlchemyError) as error:
                    cause = getattr(error, "orig", None) or error
                    if not isinstance(cause, sqlite3.IntegrityError):
                        raise
                    refused += 1
                    _log.warning("what was changed meanwhile does not fit the database: %s", error)
        self._waiting.clear()
        return refused

    def write_new(self) -> None:
        """There was no file, or a damaged one, which is set aside: all of it is written.  Raises
        sqlite3.Error or OSError where the disk does not take it.
        """
        making = beside(self._path, SALVAGED if self.is_damaged else ".part")
        making.unlink(missing_ok=True)
        make_private(making)
        with ExitStack() as undo:
            undo.callback(making.unlink, missing_ok=True)
            with closing(sqlite3.connect(making)) as target:
                self._keeper.backup(target)
            with making.open("rb") as written:
                os.fsync(written.fileno())
            undo.pop_all()
        if self.is_damaged:
            _log.warning("the damaged database is set aside as %s", set_aside(self._path))
        making.replace(self._path)
        sync_folder(self._path.parent)
        self.is_new = self.is_damaged = False

    @contextmanager
    def kept_open(self) -> Iterator[bool]:
        """For one reader; False where it may not be read any more."""
        with self._lock:
            is_open = not self._is_left
            self._readers += is_open
        try:
            yield is_open
        finally:
            with self._lock:
                self._readers -= is_open
                is_last = is_open and self._is_left and not self._readers
            if is_last:
                self.close()

    def leave(self) -> None:
        """Close the copy when its last reader has ended: closing deletes the database."""
        with self._lock:
            self._is_left, is_idle = True, not self._readers
        if is_idle:
            self.close()

    def close(self) -> None:
        self.engine.dispose()
        self._keeper.close()

    def _connect(self) -> sqlite3.Connection:
        return sqlite3.connect(
            self._name, uri=True, timeout=BUSY_TIMEOUT_S, check_same_thread=False
        )

    def _fill(self, *, is_open: bool) -> None:
        with reading_on_full_disk(self._path, is_open=is_open) as reading:
            pages = reading.execute("PRAGMA page_count").fetchone()[0]
            page_bytes = reading.execute("PRAGMA page_size").fetchone()[0]
            if pages * page_bytes <= WHOLE_BYTES_MAX:
                # Not as a backup, whose header would declare a WAL.
                reading.execute("VACUUM INTO ?", (self._name,))
                return
            self.lacks_tracks = True
            left_out = {table.__tablename__ for table in _LARGE}
            made = reading.execute(
                "SELECT type, name, sql FROM sqlite_master "
                "WHERE sql IS NOT NULL AND name NOT LIKE 'sqlite_%' ORDER BY type = 'index'"
            ).fetchall()
            for _, _, sql in made:
                self._keeper.execute(sql)
            tables = [name for kind, name, _ in made if kind == "table" and name not in left_out]
            if unreadable := copy_tables(reading, self._keeper, tables):
                raise sqlite3.DatabaseError(f"{', '.join(unreadable)} cannot be read")
