"""Migration of a database to the schema of this program.

A new file gets the tables of the models at once: to make them by all migrations, one after the
other, takes three times as long, and Alembic.  Tests compare both ways.
"""

from __future__ import annotations

from importlib.resources import files

from sqlalchemy import Connection, Engine, inspect, text

from base_station.storage.db.models import Base

_VERSIONS = files("base_station.storage.db") / "migrations" / "versions"


def migrate(engine: Engine) -> None:
    """Run the migrations that are missing; StoreError where a newer program wrote the file.

    Alembic is imported only where one may be missing: that takes a twelfth of the time in which a
    station starts, and nearly every database has the schema of this program already.
    """
    with engine.connect() as connection, connection.begin():
        if _revision(connection) == newest_revision():
            return
        if _is_new_file(connection):
            _create(connection)
            return
        from base_station.storage.db.alembic_migration import upgrade  # noqa: PLC0415

        upgrade(connection)


def newest_revision() -> str:
    """Newest revision of this program: files of migrations are named by number, in order."""
    return max(file.name for file in _VERSIONS.iterdir() if file.name[0].isdigit())[:4]


def _is_new_file(connection: Connection) -> bool:
    """Not of a server: there migrations also divide tables into partitions."""
    return connection.dialect.name == "sqlite" and not inspect(connection).get_table_names()


def _create(connection: Connection) -> None:
    Base.metadata.create_all(connection, checkfirst=False)
    connection.execute(
        text(
            "CREATE TABLE alembic_version (version_num VARCHAR(32) NOT NULL, "
            "CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num))"
        )
    )
    connection.execute(
        text("INSERT INTO alembic_version VALUES (:newest)"), {"newest": newest_revision()}
    )


def _revision(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
