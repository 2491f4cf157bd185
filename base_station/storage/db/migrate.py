"""Brings a database to the schema of this program."""

from __future__ import annotations

from importlib.resources import files

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine

from shared.errors import StoreError


def migrate(engine: Engine) -> None:
    """Run the migrations that are missing; StoreError where a newer program wrote the file."""
    with engine.connect() as connection, connection.begin():
        config = alembic_config(connection)
        current = MigrationContext.configure(connection).get_current_revision()
        script = ScriptDirectory.from_config(config)
        known = {revision.revision for revision in script.walk_revisions()}
        if current is not None and current not in known:
            raise StoreError(
                f"the database {engine.url.database} has revision {current}, which this program "
                "does not know: a newer Muster wrote it. Update Muster, or use another data folder"
            )
        if current != script.get_current_head():
            command.upgrade(config, "head")


def alembic_config(connection: Connection) -> Config:
    """Alembic's configuration for this connection; there is no alembic.ini."""
    config = Config(attributes={"connection": connection})
    config.set_main_option("script_location", str(files("base_station.storage.db") / "migrations"))
    config.set_main_option("path_separator", "os")
    return config
