"""Rows of the tables that both stations have, as one sends them to the other."""

from __future__ import annotations

from typing import Any

import msgspec
from sqlalchemy import insert, select
from sqlalchemy.orm import Session

from base_station.storage.db.models import (
    ApiToken,
    Base,
    LoginSession,
    LoginTransferTicket,
    PersonRow,
    Tombstone,
    User,
)
from base_station.storage.db.tombstones import name_of

Row = dict[str, Any]
_PICTURES = frozenset({"photo", "image"})
_ENDED: tuple[type[Base], ...] = (
    LoginTransferTicket,
    LoginSession,
    ApiToken,
    User,
    PersonRow,
)  # parts first


class ReplicatedRows(msgspec.Struct, frozen=True):
    """Rows by column; pictures only as their hashes."""

    users: tuple[Row, ...]
    tokens: tuple[Row, ...]
    sessions: tuple[Row, ...]
    hand_overs: tuple[Row, ...]
    people: tuple[Row, ...]
    base_map: tuple[Row, ...]  # one or none
    ended: tuple[Row, ...] = ()
    lost: tuple[str, ...] = ()  # tables that are not as they were


def rows_of(session: Session, table: type[Base]) -> tuple[Row, ...]:
    return tuple(map(row_of, session.scalars(select(table).order_by(*table.__table__.primary_key))))


def row_of(entry: Base) -> Row:
    names = (column.name for column in entry.__table__.columns if column.name not in _PICTURES)
    return {name: getattr(entry, name) for name in names}


def apply_tombstones(session: Session, ended: tuple[Row, ...]) -> bool:
    """True if anything was not known to be over."""
    known = set(session.scalars(select(Tombstone.what)))
    new = {row["what"]: row for row in ended if row["what"] not in known}
    if not new:
        return False
    session.execute(insert(Tombstone), list(new.values()))
    for table in _ENDED:
        for row in session.scalars(select(table)).all():
            if name_of(row) in new:
                session.delete(row)
        session.flush()
    return True


def without_ended(session: Session, rows: ReplicatedRows) -> ReplicatedRows:
    """Rows without a tombstone at this station, and which belong to no row that has one."""
    ended = set(session.scalars(select(Tombstone.what)))

    def left(table: type[Base], rows: tuple[Row, ...]) -> tuple[Row, ...]:
        return tuple(row for row in rows if name_of(table(**row)) not in ended)

    users = left(User, rows.users)
    names = {row["username"] for row in users}
    sessions = tuple(r for r in left(LoginSession, rows.sessions) if r["username"] in names)
    secrets = {row["token_hash"] for row in sessions}
    return msgspec.structs.replace(
        rows,
        users=users,
        tokens=tuple(r for r in left(ApiToken, rows.tokens) if r["username"] in names),
        sessions=sessions,
        hand_overs=tuple(
            r for r in left(LoginTransferTicket, rows.hand_overs) if r["session_hash"] in secrets
        ),
        people=left(PersonRow, rows.people),
    )
