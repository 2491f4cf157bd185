"""What no log can make again, as it stands: users, sessions, tokens, people, the base map.

A standby station copies it from the active one.  Pictures travel by themselves, named by their
hashes; the audit is only ever added to.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import msgspec
from sqlalchemy import delete, func, select
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.db.models import (
    ApiToken,
    AuditEntry,
    Base,
    BaseMap,
    HandOver,
    LoginSession,
    Person,
    User,
)
from base_station.db.store import Store

Row = dict[str, Any]
_PICTURES = frozenset({"photo", "image"})
_NUMBER = "number"  # of an audit entry, at the station that is asked


class ReplicatedRows(msgspec.Struct, frozen=True):
    """Rows by column; pictures only as their hashes."""

    users: tuple[Row, ...]
    tokens: tuple[Row, ...]
    sessions: tuple[Row, ...]
    hand_overs: tuple[Row, ...]
    people: tuple[Row, ...]
    base_map: tuple[Row, ...]  # one or none


class ReplicatedTables:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._copied_sessions: set[str] = set()

    def read(self) -> ReplicatedRows:
        with self._store.read() as session:
            return ReplicatedRows(
                users=_rows(session, User),
                tokens=_rows(session, ApiToken),
                sessions=_rows(session, LoginSession),
                hand_overs=_rows(session, HandOver),
                people=_rows(session, Person),
                base_map=_rows(session, BaseMap),
            )

    def copy(self, active: ReplicatedRows) -> tuple[str, ...]:
        """Make these tables like the active station's.  Gives who and what was only here.

        Sessions that began here stay; photos are kept where their hash is the same, and a base map
        stays until the other one has come.
        """
        with self._store.write() as session:
            dropped = (
                *_only_here(session, User.username, "user", active.users),
                *_only_here(session, ApiToken.token_id, "token", active.tokens),
                *_only_here(session, Person.person_id, "person", active.people),
            )
            _replace(session, User, User.username, active.users)
            _replace(session, ApiToken, ApiToken.token_id, active.tokens)
            _put_people(session, active.people)
            self._copy_sessions(session, active.sessions)
            if active.hand_overs:
                session.execute(insert(HandOver).on_conflict_do_nothing(), list(active.hand_overs))
            if not active.base_map:
                session.execute(delete(BaseMap))
        return dropped

    def missing_photos(self) -> Sequence[str]:
        """Ids of people whose photo has not come yet."""
        with self._store.read() as session:
            return session.scalars(
                select(Person.person_id).where(
                    Person.photo_hash.is_not(None), Person.photo.is_(None)
                )
            ).all()

    def photo(self, person_id: str) -> bytes | None:
        with self._store.read() as session:
            return session.scalar(select(Person.photo).where(Person.person_id == person_id))

    def put_photo(self, person_id: str, jpeg: bytes) -> None:
        with self._store.write() as session:
            person = session.get(Person, person_id)
            if person is not None:
                person.photo = jpeg

    def base_map(self, image_hash: str) -> bytes | None:
        with self._store.read() as session:
            wanted = select(BaseMap.image).where(BaseMap.image_hash == image_hash)
            return session.scalar(wanted)

    def has_base_map(self, row: Row) -> bool:
        with self._store.read() as session:
            return row in _rows(session, BaseMap)

    def put_base_map(self, row: Row, image: bytes) -> None:
        with self._store.write() as session:
            session.execute(delete(BaseMap))
            session.add(BaseMap(**row, image=image))

    def audit_behind(self, number: int, limit: int) -> list[Row]:
        """Entries behind one, in the order in which this station got to know; from the first one
        where it has none of that number.
        """
        with self._store.read() as session:
            newest = session.scalar(select(func.max(AuditEntry.number))) or 0
            entries = session.scalars(
                select(AuditEntry)
                .where(AuditEntry.number > (number if number <= newest else 0))
                .order_by(AuditEntry.number)
                .limit(limit)
            )
            return [_row(entry) for entry in entries]

    def unknown_audit(self, rows: Sequence[Row]) -> list[Row]:
        """Those that are not there yet."""
        ids = [row["entry_id"] for row in rows]
        with self._store.read() as session:
            known = select(AuditEntry.entry_id).where(AuditEntry.entry_id.in_(ids))
            there = set(session.scalars(known))
        return [row for row in rows if row["entry_id"] not in there]

    def add_audit(self, rows: Sequence[Row]) -> None:
        """Those that are there already stay as they are."""
        new = [{name: row[name] for name in row if name != _NUMBER} for row in rows]
        if new:
            with self._store.write() as session:
                session.execute(insert(AuditEntry).on_conflict_do_nothing(), new)

    def _copy_sessions(self, session: Session, rows: tuple[Row, ...]) -> None:
        there = {row["token_hash"] for row in rows}
        ended = self._copied_sessions - there
        session.execute(delete(LoginSession).where(LoginSession.token_hash.in_(ended)))
        if rows:
            session.execute(insert(LoginSession).on_conflict_do_nothing(), list(rows))
        self._copied_sessions = there


def _rows(session: Session, table: type[Base]) -> tuple[Row, ...]:
    return tuple(map(_row, session.scalars(select(table).order_by(*table.__table__.primary_key))))


def _row(entry: Base) -> Row:
    names = (column.name for column in entry.__table__.columns if column.name not in _PICTURES)
    return {name: getattr(entry, name) for name in names}


def _only_here(
    session: Session, key: InstrumentedAttribute[str], what: str, rows: Iterable[Row]
) -> Iterable[str]:
    here = set(session.scalars(select(key)))
    return (f"{what} {one}" for one in sorted(here - {row[key.key] for row in rows}))


def _replace(
    session: Session, table: type[Base], key: InstrumentedAttribute[str], rows: tuple[Row, ...]
) -> None:
    session.execute(delete(table).where(key.not_in([row[key.key] for row in rows])))
    for row in rows:
        statement = insert(table).values(**row)
        session.execute(statement.on_conflict_do_update(index_elements=[key], set_=row))


def _put_people(session: Session, rows: tuple[Row, ...]) -> None:
    session.execute(delete(Person).where(Person.person_id.not_in([r["person_id"] for r in rows])))
    for row in rows:
        person = session.get(Person, row["person_id"])
        if person is None:
            session.add(Person(**row, photo=None))
            continue
        if person.photo_hash != row["photo_hash"]:
            person.photo = None
        for name, value in row.items():
            setattr(person, name, value)
