"""Alembic's entry: runs inside ``storage.db.migrate``, on the connection given there."""

from __future__ import annotations

from alembic import context

from base_station.storage.db.models import Base
from base_station.storage.db.track_partitions import is_partition

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=Base.metadata,
    render_as_batch=True,
    compare_type=True,
    include_name=lambda name, kind, _: kind != "table" or not is_partition(str(name)),
)
with context.begin_transaction():
    context.run_migrations()
