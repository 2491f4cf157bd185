"""Pages of lists that grow without limit, the newest rows first."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from sqlalchemy import Select
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.storage.db.models import Base
from shared.clock import NS_PER_MS

Row = TypeVar("Row", bound=Base)


def newest(
    session: Session,
    wanted: Select[Row],
    t_ns: InstrumentedAttribute[int],
    key: InstrumentedAttribute[str] | InstrumentedAttribute[int],
    limit: int | None,
) -> Sequence[Row]:
    """The newest ``limit`` of those wanted, by ``t_ns``, in one instant by ``key``; None: all.

    A page never splits the rows of one millisecond, and is longer where needed: so the next one,
    of rows before the last millisecond of this, goes on without a gap.
    """
    if limit is not None:
        times = wanted.with_only_columns(t_ns).order_by(t_ns.desc())
        last_ns = session.scalar(times.offset(limit - 1).limit(1))
        if last_ns is not None:
            wanted = wanted.where(t_ns >= last_ns // NS_PER_MS * NS_PER_MS)
    return session.scalars(wanted.order_by(t_ns.desc(), key.desc())).all()
