"""Brings a database to the schema of this program."""

from __future__ import annotations

from importlib.resources import files

from sqlalchemy import Connection, Engine, inspect, text

_VERSIONS = files("base_station.storage.db") / "migrations" / "versions"


def migrate(engine: Engine) -> None:
    """Run the migrations that are missing; StoreError where a newer program wrote the file.

    Alembic is imported only where one may be missing: that takes a twelfth of the time in which a
    station starts, and nearly every database has the schema of this program already.
    """
    with engine.connect() as connection, connection.begin():
        if _revision(connection) == newest_revision():
            return
        from base_station.storage.db.alembic_migration import upgrade  # noqa: PLC0415

        upgrade(connection)


def newest_revision() -> str:
    """Newest revision of this program: files of migrations are named by number, in order."""
    return max(file.name for file in _VERSIONS.iterdir() if file.name[0].isdigit())[:4]


def _revision(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
