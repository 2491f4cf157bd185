"""Alembic's entry: runs inside ``storage.db.migrate``, on the connection given there."""

from __future__ import annotations

from alembic import context

from base_station.storage.db.models import Base

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=Base.metadata,
    render_as_batch=True,
    compare_type=True,
)
with context.begin_transaction():
    context.run_migrations()
