"""Partitions of the tracks on a server: one for each month of UTC, made when its first point comes.

A query of an incident reads the months of that alone, and an old month can be moved or dropped
without a search through the others.
"""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime

from sqlalchemy import text
from sqlalchemy.orm import Session

from base_station.storage.db.models import TrackPoint

_TABLE = TrackPoint.__tablename__


def make_partitions(session: Session, seconds: Iterable[int]) -> None:
    """Make the partitions of these times, in seconds since 1970.  Only for the one writer."""
    for year, month in sorted({_month_of(t_s) for t_s in seconds}):
        name = f"{_TABLE}_{year:04}_{month:02}"
        if session.scalar(text("SELECT to_regclass(:name)"), {"name": name}) is None:
            begin_s = _begin_s(year, month)
            end_s = _begin_s(year + month // 12, month % 12 + 1)
            session.execute(
                text(
                    f"CREATE TABLE {name} PARTITION OF {_TABLE} "
                    f"FOR VALUES FROM ({begin_s}) TO ({end_s})"
                )
            )


def is_partition(table: str) -> bool:
    return table.startswith(f"{_TABLE}_")


def _month_of(t_s: int) -> tuple[int, int]:
    at = datetime.fromtimestamp(t_s, UTC)
    return at.year, at.month


def _begin_s(year: int, month: int) -> int:
    return int(datetime(year, month, 1, tzinfo=UTC).timestamp())
