"""Tables that no log can make again and that are replicated: users, sessions, tokens, people, the
base map.

A standby station copies them from the active one.  A removal at either holds at both
(``tombstones``), and of a role and a password the later one holds.  Rows that either has lost with
its database (``lost_tables``) come back from the other.  Pictures travel by themselves, named by
their hashes; the audit is only ever added to.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from sqlalchemy import delete, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.storage.db.database import Database
from base_station.storage.db.lost_tables import lost_tables, restore_lost_rows, with_what_it_lost
from base_station.storage.db.models import (
    ApiToken,
    AuditEntry,
    Base,
    BaseMap,
    LoginSession,
    LoginTransferTicket,
    LostTable,
    PersonRow,
    Tombstone,
    User,
)
from base_station.storage.db.replicated_rows import (
    ReplicatedRows,
    Row,
    apply_tombstones,
    row_of,
    rows_of,
    without_ended,
)
from base_station.storage.db.upserts import insert_into

_REMOVED = "removed_ns"  # of an earlier version's rows there is none
_NUMBER = "number"  # of an audit entry, at the other station
_SINCE = {"role_ns": 0, "password_ns": 0}  # as sent by a station of an earlier version


class ReplicatedTables:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database) -> None:
        self._store = store

    def read(self) -> ReplicatedRows:
        with self._store.read() as session:
            return ReplicatedRows(
                users=rows_of(session, User),
                tokens=rows_of(session, ApiToken),
                sessions=rows_of(session, LoginSession),
                hand_overs=rows_of(session, LoginTransferTicket),
                people=rows_of(session, PersonRow),
                base_map=rows_of(session, BaseMap),
                ended=rows_of(session, Tombstone),
                lost=lost_tables(session),
            )

    def note_lost(self, tables: Collection[str]) -> None:
        """These were made again without their rows: they come back from the other station."""
        with self._store.write() as session:
            for name in tables:
                session.merge(LostTable(name=name))

    def copy(self, active: ReplicatedRows) -> tuple[str, ...]:
        """Copy the active station's tables into these; returns the names of rows that were only
        here.

        Sessions that began here stay; photos are kept where their hash is the same, and a base map
        stays until the other one has come.  Rows removed here do not come back, and rows
        that the active station has lost stay here until it has taken them back.
        """
        with self._store.write() as session:
            apply_tombstones(session, active.ended)
            session.execute(delete(LostTable).where(LostTable.name.not_in(active.lost)))
            theirs = with_what_it_lost(session, without_ended(session, active))
            dropped = (
                *_local_only(session, User.username, "user", theirs.users),
                *_local_only(session, ApiToken.token_id, "token", theirs.tokens),
                *_local_only(session, PersonRow.person_id, "person", theirs.people),
            )
            users = tuple(_with_the_later(session, row) for row in theirs.users)
            _replace(session, User, User.username, users)
            _replace(session, ApiToken, ApiToken.token_id, theirs.tokens)
            _put_people(session, theirs.people)
            for table, rows in (
                (LoginSession, theirs.sessions),
                (LoginTransferTicket, theirs.hand_overs),
            ):
                if rows:
                    session.execute(
                        insert_into(session, table).on_conflict_do_nothing(), list(rows)
                    )
            if not theirs.base_map:
                session.execute(delete(BaseMap))
        return dropped

    def restore_lost_rows(self, standby: ReplicatedRows) -> tuple[str, ...]:
        """Take back rows that this station lost with its database and the standby still has; gives
        their names.  Pictures are requested afterwards.  Rows that were entered here since stay.
        The administrator that the station made itself, because it had no user, is removed where
        another one exists again.
        """
        with self._store.write() as session:
            return restore_lost_rows(session, standby)

    def lost(self) -> tuple[str, ...]:
        """Tables that were made again and wait for their rows."""
        with self._store.read() as session:
            return lost_tables(session)

    def lacks_base_map(self) -> bool:
        """True if there is none because it was lost."""
        with self._store.read() as session:
            return "base_map" in lost_tables(session) and not rows_of(session, BaseMap)

    def apply_removals(self, standby: ReplicatedRows) -> bool:
        """Apply removals, and later roles and passwords, that the standby recorded without contact;
        nothing else of it.  True if there was any.
        """
        with self._store.write() as session:
            some = apply_tombstones(session, standby.ended)
            for row in without_ended(session, standby).users:
                user = session.get(User, row["username"])
                if user is None or user.created_ns != row["created_ns"]:
                    continue
                for name, value in _with_the_later(session, row).items():
                    some = some or getattr(user, name) != value
                    setattr(user, name, value)
            return _remove_people(session, standby.people) or some

    def missing_photos(self) -> Sequence[str]:
        """Ids of people whose photo has not come yet."""
        with self._store.read() as session:
            return session.scalars(
                select(PersonRow.person_id).where(
                    PersonRow.photo_hash.is_not(None), PersonRow.photo.is_(None)
                )
            ).all()

    def photo(self, person_id: str) -> bytes | None:
        with self._store.read() as session:
            return session.scalar(select(PersonRow.photo).where(PersonRow.person_id == person_id))

    def put_photo(self, person_id: str, jpeg: bytes) -> None:
        with self._store.write() as session:
            person = session.get(PersonRow, person_id)
            if person is not None:
                person.photo = jpeg

    def base_map(self, image_hash: str) -> bytes | None:
        with self._store.read() as session:
            wanted = select(BaseMap.image).where(BaseMap.image_hash == image_hash)
            return session.scalar(wanted)

    def has_base_map(self, row: Row) -> bool:
        with self._store.read() as session:
            return row in rows_of(session, BaseMap)

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
            return [row_of(entry) for entry in entries]

    def unknown_audit(self, rows: Sequence[Row]) -> list[Row]:
        """Return the entries that are not here yet."""
        ids = [row["entry_id"] for row in rows]
        with self._store.read() as session:
            known = select(AuditEntry.entry_id).where(AuditEntry.entry_id.in_(ids))
            there = set(session.scalars(known))
        return [row for row in rows if row["entry_id"] not in there]

    def add_audit(self, rows: Sequence[Row]) -> None:
        """Add audit entries; existing ones stay unchanged."""
        new = [{name: row[name] for name in row if name != _NUMBER} for row in rows]
        if new:
            with self._store.write() as session:
                session.execute(insert_into(session, AuditEntry).on_conflict_do_nothing(), new)


def _with_the_later(session: Session, theirs: Row) -> Row:
    """Another station's row of a user with the later role and password of the two.

    Both stations come to the same, whichever receives the other's first.  Where the passwords
    differ, no login with the one that no longer holds stays.
    """
    user = session.get(User, theirs["username"])
    if user is None or user.created_ns != theirs["created_ns"]:
        return theirs
    mine, row = row_of(user), _SINCE | theirs
    if mine["role_ns"] > row["role_ns"]:
        row |= {name: mine[name] for name in ("role", "role_ns")}
    holds, other = (mine, row) if mine["password_ns"] > row["password_ns"] else (row, mine)
    superseded = holds["password_hash"] != other["password_hash"]
    return row | {
        "password_hash": holds["password_hash"],
        "password_ns": holds["password_ns"],
        "generation": max(holds["generation"], other["generation"] + superseded),
    }


def _local_only(
    session: Session, key: InstrumentedAttribute[str], what: str, rows: Iterable[Row]
) -> Iterable[str]:
    here = set(session.scalars(select(key)))
    return (f"{what} {one}" for one in sorted(here - {row[key.key] for row in rows}))


def _replace(
    session: Session, table: type[Base], key: InstrumentedAttribute[str], rows: tuple[Row, ...]
) -> None:
    session.execute(delete(table).where(key.not_in([row[key.key] for row in rows])))
    for row in rows:
        statement = insert_into(session, table).values(**row)
        session.execute(statement.on_conflict_do_update(index_elements=[key], set_=row))


def _remove_people(session: Session, rows: tuple[Row, ...]) -> bool:
    """Remove people who were removed from the roster at the other station; True if any were."""
    some = False
    for row in rows:
        person = session.get(PersonRow, row["person_id"])
        removed_ns = row.get(_REMOVED)
        if person is not None and person.removed_ns is None and removed_ns is not None:
            person.removed_ns, person.photo, person.photo_hash = removed_ns, None, None
            some = True
    return some


def _put_people(session: Session, rows: tuple[Row, ...]) -> None:
    """Store people of the other station; those removed here stay so."""
    session.execute(
        delete(PersonRow).where(PersonRow.person_id.not_in([r["person_id"] for r in rows]))
    )
    for row in rows:
        person = session.get(PersonRow, row["person_id"])
        if person is None:
            session.add(PersonRow(**row, photo=None))
            continue
        if person.removed_ns is not None and row.get(_REMOVED) is None:
            continue
        if person.photo_hash != row["photo_hash"]:
            person.photo = None
        for name, value in row.items():
            setattr(person, name, value)
