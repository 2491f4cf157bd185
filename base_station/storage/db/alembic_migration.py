"""Migrations that a database is missing, run by Alembic."""

from __future__ import annotations

from importlib.resources import files

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection

from shared.errors import StoreError


def upgrade(connection: Connection) -> None:
    """StoreError where the database has a revision that this program does not know."""
    config = alembic_config(connection)
    current = MigrationContext.configure(connection).get_current_revision()
    script = ScriptDirectory.from_config(config)
    known = {revision.revision for revision in script.walk_revisions()}
    if current is not None and current not in known:
        raise StoreError(
            f"the database {connection.engine.url.database} has revision {current}, which this "
            "program does not know: a newer Muster wrote it. Update Muster, or use another data "
            "folder"
        )
    command.upgrade(config, "head")


def alembic_config(connection: Connection) -> Config:
    """Alembic's configuration for this connection; there is no alembic.ini."""
    config = Config(attributes={"connection": connection})
    config.set_main_option("script_location", str(files("base_station.storage.db") / "migrations"))
    config.set_main_option("path_separator", "os")
    return config
