"""Recovery of tables that a database lost when it was made again: the other station has a copy.

Until then its tables are not taken for what users have done: the other station keeps its rows.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
from sqlalchemy import delete, insert, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.accounts.principals import Role
from base_station.storage.db.accounts import GENERATED_NS
from base_station.storage.db.models import (
    ApiToken,
    Base,
    BaseMap,
    LoginSession,
    LostTable,
    PersonRow,
    User,
)
from base_station.storage.db.replicated_rows import (
    ReplicatedRows,
    Row,
    apply_tombstones,
    rows_of,
    without_ended,
)


def lost_tables(session: Session) -> tuple[str, ...]:
    return tuple(session.scalars(select(LostTable.name).order_by(LostTable.name)))


def with_what_it_lost(session: Session, theirs: ReplicatedRows) -> ReplicatedRows:
    """Another station's tables, with this one's rows of those that it lost."""
    own: dict[str, tuple[Row, ...]] = {}
    if "users" in theirs.lost:
        own = {"users": rows_of(session, User), "sessions": (), "hand_overs": ()}
    if "api_tokens" in theirs.lost:
        users = {row["username"] for row in own.get("users", theirs.users)}
        tokens = rows_of(session, ApiToken)
        own["tokens"] = tuple(row for row in tokens if row["username"] in users)
    if "people" in theirs.lost:
        own["people"] = rows_of(session, PersonRow)
    if "base_map" in theirs.lost:
        own["base_map"] = rows_of(session, BaseMap)
    return msgspec.structs.replace(theirs, **own)


def restore_lost_rows(session: Session, standby: ReplicatedRows) -> tuple[str, ...]:
    """Take back rows that this station lost and ``standby`` has; gives their names."""
    lost = set(lost_tables(session))
    if not lost:
        return ()
    apply_tombstones(session, standby.ended)
    theirs = without_ended(session, standby)
    back: list[str] = []
    if "users" in lost:
        if any(_is_administrator(row) for row in theirs.users):
            session.execute(delete(User).where(User.password_ns == GENERATED_NS))
        back += _added(session, User, "user", User.username, theirs.users)
        _added(session, LoginSession, "login", LoginSession.token_hash, theirs.sessions)
    if "api_tokens" in lost:
        users = set(session.scalars(select(User.username)))
        tokens = (row for row in theirs.tokens if row["username"] in users)
        back += _added(session, ApiToken, "token", ApiToken.token_id, tokens)
    if "people" in lost:
        back += _added(session, PersonRow, "person", PersonRow.person_id, theirs.people)
    session.execute(delete(LostTable))
    return tuple(back)


def _added(
    session: Session,
    table: type[Base],
    what: str,
    key: InstrumentedAttribute[str],
    rows: Iterable[Row],
) -> list[str]:
    """Adds the rows of which there is none of that name; gives these names."""
    here = set(session.scalars(select(key)))
    new = [row for row in rows if row[key.key] not in here]
    if new:
        session.execute(insert(table), new)
    return [f"{what} {row[key.key]}" for row in new]


def _is_administrator(row: Row) -> bool:
    """True for an administrator who has logged in once, and so knows the password."""
    is_generated = row.get("password_ns", 0) == GENERATED_NS
    return not is_generated and bool(row["role"] == Role.ADMINISTRATOR.word)
