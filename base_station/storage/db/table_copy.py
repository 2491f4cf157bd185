"""Copies of tables from one database into another: from a file to a server, and back."""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Table, func, select

from base_station.storage.db.database import Database
from base_station.storage.db.models import PROJECTIONS, AuditEntry, Base, TrackPoint, User
from base_station.storage.db.track_partitions import make_partitions
from base_station.storage.db.upserts import is_on_server

_ROWS = 5_000  # of a table, at a time
_PROJECTED = frozenset(table.__tablename__ for table in PROJECTIONS)
_NUMBERED = AuditEntry.number.key  # given anew, in the same order


def has_users(store: Database) -> bool:
    """True if a station has worked with it before."""
    with store.read() as session:
        return bool(session.scalar(select(func.count()).select_from(User)))


def copy_kept(source: Database, target: Database) -> None:
    """Copy the tables that no log has into empty tables, all or nothing."""
    _copy(source, target, (one for one in _tables() if one.name not in _PROJECTED))


def copy_tables_of(source: Database, target: Database) -> None:
    """Copy everything into tables that are empty, all or nothing."""
    _copy(source, target, _tables())


def _tables() -> list[Table]:
    """Return the tables in an order in which referenced ones come first."""
    return Base.metadata.sorted_tables


def _copy(source: Database, target: Database, tables: Iterable[Table]) -> None:
    with source.read() as reading, target.write() as writing:
        for table in tables:
            columns = [one for one in table.columns if one.name != _NUMBERED]
            wanted = select(*columns).order_by(*table.primary_key)
            rows = reading.execute(wanted.execution_options(yield_per=_ROWS))
            for part in rows.mappings().partitions(_ROWS):
                new = [dict(row) for row in part]
                if table.name == TrackPoint.__tablename__ and is_on_server(writing):
                    make_partitions(writing, (row["t_s"] for row in new))
                writing.execute(table.insert(), new)
