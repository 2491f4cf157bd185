"""The tables of a station on a PostgreSQL server.

While the server is away no caller waits for it: each gets the reason at once, and every two seconds
one caller tries to connect.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Self

from sqlalchemy import Connection, Engine, text
from sqlalchemy.exc import OperationalError, SQLAlchemyError
from sqlalchemy.orm import Session

from base_station.storage.db.database import IN_MEMORY
from base_station.storage.db.migrate import migrate
from base_station.storage.db.models import Base
from base_station.storage.db.server_address import ServerAddress
from base_station.storage.db.server_engine import STATION_LOCK, STATION_WAIT_S, server_engines
from base_station.storage.db.server_errors import is_about_certificate, is_away, store_error
from shared.coded_text import coded, join_texts, text_of_error
from shared.errors import DatabaseAwayError, StoreError

_log = logging.getLogger(__name__)

RETRY_S = 2.0  # between two attempts to reach the server
TRY_S = 10.0  # limit of one attempt
_SEE_ADDRESS = (
    "; see address, user and password (database_password_file, or PGPASSWORD in the environment)"
)
OLDEST_SERVER = 140_000  # in the form of server_version_num: 14.0


class ServerStore:
    """A ``Database``.  Thread-safe."""

    def __init__(self, server: ServerAddress, *, is_station: bool = False) -> None:
        """``is_station``: no other station may work on this database while this one does.

        Raises StoreError where the server cannot be used, or a newer program made the tables.
        """
        self.loss: str = ""
        self._is_station = is_station
        self._lock = threading.Lock()  # guards the fields below
        self._away = ""  # why the server does not answer
        self._next_try_s = 0.0
        self._guard: Connection | None = None  # holds the lock of a station
        self._engines = server_engines(server, is_limited=is_station)
        self.name = self._engines.writing.url.render_as_string(hide_password=True)
        try:
            self._open(server)
        except SQLAlchemyError as error:
            self.close()
            kind = DatabaseAwayError if is_away(error) else StoreError
            refusal = store_error(error, "it refuses")
            advice = "" if is_about_certificate(refusal) else _SEE_ADDRESS
            raise kind(
                f"{self.name} cannot be opened as the station's database: {refusal}{advice}"
            ) from error
        except StoreError:
            self.close()
            raise

    @property
    def engine(self) -> Engine:
        return self._engines.writing

    @property
    def problem(self) -> str:
        away = self._away
        text = away and coded(
            "database-away",
            "{reason}; people are shown and commanded as before, and the log has everything; "
            "logins, past incidents, users and people wait for the database; see that the server "
            "runs and can be reached",
            reason=away,
        )
        return join_texts((text, self.loss))

    @property
    def in_memory(self) -> bool:
        return False

    @property
    def is_away(self) -> bool:
        return bool(self._away)

    @contextmanager
    def read(self) -> Iterator[Session]:
        with (
            self._asking("the database cannot be read"),
            Session(self._engines.reading, expire_on_commit=False) as session,
        ):
            yield session

    @contextmanager
    def write(self, *, is_kept: bool = True) -> Iterator[Session]:  # noqa: ARG002  # of all databases
        with (
            self._asking("the database did not take a change"),
            Session(self._engines.writing, expire_on_commit=False) as session,
        ):
            session.connection()  # from here on there is no other writer
            yield session
            session.commit()
            session.info[IN_MEMORY] = False

    def check_disk(self) -> None:
        if self.is_away:
            with suppress(StoreError), self.read() as session:
                session.execute(text("SELECT 1"))

    def compact(self) -> int:
        """The server's own copies (its WAL, its replicas, its backups) are its administrator's."""
        tables = ", ".join(f'"{table.name}"' for table in Base.metadata.sorted_tables)
        with (
            self._asking("the database cannot be made compact"),
            self._engines.plain.connect() as connection,
        ):
            connection.execute(text(f"VACUUM (FULL) {tables}"))
        return 0

    def close(self) -> None:
        if self._guard is not None:
            with suppress(SQLAlchemyError):
                self._guard.close()
        self._engines.dispose()

    # ---- at the beginning

    def _open(self, server: ServerAddress) -> None:
        """Raises SQLAlchemyError or StoreError."""
        with self._engines.plain.connect() as connection:
            version = int(connection.scalar(text("SHOW server_version_num")) or 0)
            encoding = connection.scalar(text("SHOW server_encoding"))
            only_read = connection.scalar(text("SHOW transaction_read_only"))
        if version < OLDEST_SERVER:
            raise StoreError(
                f"{self.name} is of PostgreSQL {version // 10_000}: install version "
                f"{OLDEST_SERVER // 10_000} or newer"
            )
        if encoding != "UTF8":
            raise StoreError(
                f"{self.name} keeps text as {encoding}: make the database anew with ENCODING 'UTF8'"
            )
        if self._is_station and only_read == "on":
            raise StoreError(
                f"{self.name} can only be read: give the address of the primary server, and see "
                "default_transaction_read_only"
            )
        if self._is_station:
            self._be_the_only_station(STATION_WAIT_S)
        patient = server_engines(server, is_limited=False)  # a migration may take its time
        try:
            migrate(patient.writing)
        finally:
            patient.dispose()

    def _be_the_only_station(self, wait_s: int) -> None:
        """Take the lock that one station at a time has, for as long as this connection lasts."""
        before, self._guard = self._guard, None
        if before is not None:
            before.invalidate()
            before.close()
        guard = self._engines.plain.connect()
        try:
            guard.execute(text(f"SET lock_timeout = '{wait_s}s'"))
            guard.execute(text(f"SELECT pg_advisory_lock({STATION_LOCK})"))
        except OperationalError as error:
            guard.invalidate()
            guard.close()
            if is_away(error):
                raise
            raise StoreError(
                f"another station works with {self.name}: give each station a database of its own"
            ) from error
        self._guard = guard

    # ---- while the server is away

    @contextmanager
    def _asking(self, what: str) -> Iterator[None]:
        """Context of a request to the server.  Raises StoreError."""
        is_trying = self._is_trying()
        try:
            if is_trying and self._is_station:
                self._be_the_only_station(1)
            yield
        except SQLAlchemyError as error:
            refusal = store_error(error, what)
            if isinstance(refusal, DatabaseAwayError):
                self._note_away(text_of_error(refusal))
                raise DatabaseAwayError(self.problem) from error
            raise refusal from error
        if is_trying:
            _log.warning("the database server is back")
            self._away = ""

    def _is_trying(self) -> bool:
        """True for the one caller that tries to reach the server; False where it answers.  Raises
        DatabaseAwayError for all other callers.
        """
        with self._lock:
            if not self._away:
                return False
            now_s = time.monotonic()
            if now_s < self._next_try_s:
                raise DatabaseAwayError(self.problem)
            self._next_try_s = now_s + TRY_S
            return True

    def _note_away(self, reason: str) -> None:
        with self._lock:
            if not self._away:
                _log.warning("%s", reason)
            self._away = reason
            self._next_try_s = time.monotonic() + RETRY_S

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
