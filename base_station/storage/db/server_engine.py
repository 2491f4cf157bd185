"""Engines for PostgreSQL.  Transactions that change something wait for each other, as in SQLite."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any, NamedTuple

from sqlalchemy import Connection, Engine, NullPool, create_engine, event

from base_station.storage.db.server_address import ServerAddress
from shared.errors import StoreError

LOCK_WAIT_S = 10  # another process (``muster base users add``) may be writing
WRITERS_LOCK = 0x6D75_7374_6572_0001  # advisory, held by the writer for one transaction
STATION_LOCK = 0x6D75_7374_6572_0002  # advisory, of the one station that works on the database
STATION_WAIT_S = 40  # until the server has found that a station before is gone
_ALONE = "muster_alone"
_WITHIN_S = 5  # a server that does not take a connection by then is away
_CONNECTION = {
    "connect_timeout": _WITHIN_S,
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
    "tcp_user_timeout": 10_000,  # milliseconds: a network that takes nothing
    # And the server ends a connection whose machine is gone, with the locks that it held.
    "options": "-c tcp_keepalives_idle=10 -c tcp_keepalives_interval=5 -c tcp_keepalives_count=3",
    "application_name": "muster",
}


class ServerEngines(NamedTuple):
    plain: Engine  # each statement by itself, on a connection of its own, however long it takes
    reading: Engine  # one consistent view for each transaction
    writing: Engine  # one transaction at a time, of all programs

    def dispose(self) -> None:
        for engine in (self.plain, self.writing):  # reading and writing share their connections
            engine.dispose()


def server_engines(server: ServerAddress, *, is_limited: bool) -> ServerEngines:
    """``is_limited``: a transaction whose server does not answer in time is given up.

    Raises StoreError where psycopg is not installed, or the password cannot be read.
    """
    if find_spec("psycopg") is None:
        raise StoreError(
            "the library psycopg, which speaks with PostgreSQL, is not installed: "
            "pip install --require-hashes -r deploy/requirements-postgresql.lock"
        )
    settings: dict[str, Any] = dict(_CONNECTION)
    if (password := server.password()) is not None:
        settings["password"] = password
    if not server.is_on_this_machine and "sslmode=" not in server.url:
        settings["sslmode"] = "verify-full"
    engine = create_engine(
        server.url, connect_args=settings, pool_pre_ping=True, pool_size=5, max_overflow=25
    )
    event.listen(engine, "begin", _begin)
    event.listen(engine, "before_cursor_execute", _without_nul, retval=True)
    if is_limited:
        event.listen(engine, "do_connect", _connect_limited)
    return ServerEngines(
        create_engine(
            server.url,
            connect_args=settings,
            poolclass=NullPool,
            isolation_level="AUTOCOMMIT",
        ),
        engine.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True),
        engine.execution_options(**{_ALONE: True}),
    )


def _connect_limited(
    _dialect: object, _record: object, arguments: list[Any], settings: dict[str, Any]
) -> Any:
    from base_station.storage.db.server_connection import LimitedConnection  # noqa: PLC0415

    return LimitedConnection.connect(*arguments, **settings)


def _begin(connection: Connection) -> None:
    """Begin a transaction as SQLite's BEGIN IMMEDIATE does: no other writer changes rows that it
    has read.
    """
    if connection.get_execution_options().get(_ALONE):
        connection.exec_driver_sql(
            f"SET LOCAL lock_timeout = '{LOCK_WAIT_S}s'; "
            f"SELECT pg_advisory_xact_lock({WRITERS_LOCK})"
        )


def _without_nul(
    _connection: Connection,
    _cursor: object,
    statement: str,
    parameters: Any,
    _context: object,
    _executemany: bool,  # SQLAlchemy's signature
) -> tuple[str, Any]:
    """PostgreSQL's text has no NUL; one in a received text must not cost the rows beside it."""
    return statement, _storable(parameters)


def _storable(parameters: Any) -> Any:
    """``parameters``: of one row by name, of many rows, or one value of them."""
    if isinstance(parameters, str):
        return parameters.replace("\0", "\ufffd")
    if isinstance(parameters, dict):
        return {name: _storable(value) for name, value in parameters.items()}
    if isinstance(parameters, list):
        return [_storable(row) for row in parameters]
    return parameters
