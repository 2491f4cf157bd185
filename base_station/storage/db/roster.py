"""People, units, and the wearers of units."""

from __future__ import annotations

import secrets
from collections.abc import Collection, Mapping, Sequence

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from base_station.core.idempotency import KEY_DIGITS
from base_station.storage.db.database import Database
from base_station.storage.db.erasure import known_names
from base_station.storage.db.known_people import (
    FORGOTTEN,
    KnownPerson,
    known_person,
    load_people,
    person_lookup,
    shown_text,
    shown_wearer,
)
from base_station.storage.db.models import Assignment, PersonRow, Unit
from base_station.storage.db.pages import newest
from base_station.storage.db.people_import import ImportStep, ListedPerson, import_steps
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import UserError


class Roster:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database, clock: Clock) -> None:
        self._store = store
        self._clock = clock
        self._known = self._load_people()

    def people(self) -> Sequence[PersonRow]:
        with self._store.read() as session:
            by_name = select(PersonRow).where(PersonRow.removed_ns.is_(None))
            ordered = by_name.order_by(func.lower(PersonRow.name), PersonRow.person_id)
            return session.scalars(ordered).all()

    def person(self, person_id: str) -> PersonRow | None:
        with self._store.read() as session:
            return _on_roster(session, person_id)

    # ---- names of ids, from memory: also for the engine's thread

    def known(self, person_id: str) -> KnownPerson:
        """A person who is or was on the roster."""
        return person_lookup(self._known)(person_id)

    def known_people(self) -> dict[str, KnownPerson]:
        """Return all known people by id."""
        return dict(self._known)

    def shown(self, text: str) -> str:
        """Return a text of the log with names in place of references."""
        return shown_text(text, self.known)

    def wearer(self, assignment: Assignment) -> KnownPerson:
        return shown_wearer(assignment, self.known)

    def ids_by_name(self) -> dict[str, str]:
        """Ids of all who are or were on the roster and are not forgotten."""
        known = self.known_people().items()
        return {one.name: person_id for person_id, one in known if one is not FORGOTTEN}

    def crew(self, name: str) -> tuple[str, ...]:
        """Ids of the members."""
        return tuple(one.person_id for one in self.people() if one.crew == name)

    def names_of(self, person_id: str) -> Collection[str]:
        """Present and former names of a person, who may be in the roster no more."""
        with self._store.read() as session:
            return known_names(session, person_id)

    def add_person(self, name: str, crew: str, role: str, row_id: str = "") -> PersonRow:
        """``row_id`` (``core.idempotency.row_id``): a person who was added with that key before is
        returned.
        """
        person = self._new_row(row_id or secrets.token_hex(8), name, crew, role)
        with self._store.write() as session:
            if row_id:
                same_key = PersonRow.person_id.startswith(row_id[:KEY_DIGITS])
                before = session.scalars(select(PersonRow).where(same_key)).first()
                if before is not None:
                    return before
            session.add(person)
        self._known[person.person_id] = known_person(person)
        return person

    def _new_row(self, person_id: str, name: str, crew: str, role: str) -> PersonRow:
        return PersonRow(
            person_id=person_id,
            name=name,
            crew=crew,
            role=role,
            created_ns=self._clock.utc_ns(),
            photo=None,
            photo_hash=None,
            removed_ns=None,
        )

    def add_unknown_people(self, people: Mapping[str, KnownPerson]) -> None:
        """Add names of people by their ids, for a log of another station; known people stay
        unchanged.
        """
        with self._store.write() as session:
            for person_id, one in people.items():
                if session.get(PersonRow, person_id) is None:
                    session.add(self._new_row(person_id, one.name, one.crew, one.role))
        self._known = self._load_people()

    def change_person(self, person_id: str, name: str, crew: str, role: str) -> PersonRow | None:
        with self._store.write() as session:
            person = _on_roster(session, person_id)
            if person is not None:
                person.name, person.crew, person.role = name, crew, role
        if person is not None:
            self._known[person_id] = known_person(person)
        return person

    def preview_import(self, listed: Sequence[ListedPerson]) -> list[ImportStep]:
        """Steps that ``import_people`` would take now."""
        with self._store.read() as session:
            return import_steps(_all_on_roster(session), listed)

    def import_people(self, listed: Sequence[ListedPerson]) -> list[ImportStep]:
        """Add or change all listed people, or none: UserError where two people have the name."""
        written: list[PersonRow] = []
        with self._store.write() as session:
            on_roster = _all_on_roster(session)
            by_id = {person.person_id: person for person in on_roster}
            steps = import_steps(on_roster, listed)
            for step in steps:
                if step.kind == "ambiguous":
                    raise UserError(
                        coded(
                            "name-of-two", "{name} is the name of two people here", name=step.name
                        )
                    )
                person = by_id.get(step.person_id)
                if person is None:
                    person = self._new_row(step.person_id, step.name, step.crew, step.role)
                    session.add(person)
                person.crew, person.role = step.crew, step.role
                written.append(person)
        self._known |= {person.person_id: known_person(person) for person in written}
        return steps

    def remove_person(self, person_id: str) -> bool:
        """Remove a person from the roster; the name stays for earlier records.  UserError while the
        person wears a unit.
        """
        with self._store.write() as session:
            person = _on_roster(session, person_id)
            if person is None:
                return False
            worn = _worn_by(session, person_id)
            if worn:
                raise UserError(
                    coded(
                        "person-wears",
                        "{name} wears {units}; unassign that first",
                        name=person.name,
                        units=", ".join(worn),
                    )
                )
            person.removed_ns = self._clock.utc_ns()
            person.photo = person.photo_hash = None
        self._known[person_id] = known_person(person)
        return True

    def set_photo(self, person_id: str, jpeg: bytes, photo_hash: str) -> PersonRow | None:
        with self._store.write() as session:
            person = _on_roster(session, person_id)
            if person is None:
                return None
            person.photo, person.photo_hash = jpeg, photo_hash
        self._known[person_id] = known_person(person)
        return person

    def forget(self, person_id: str) -> None:
        """Hide the name from now on; the row is deleted after that."""
        self._known[person_id] = FORGOTTEN

    def photo(self, person_id: str) -> tuple[bytes, str] | None:
        """JPEG and its hash."""
        with self._store.read() as session:
            wanted = select(PersonRow.photo, PersonRow.photo_hash).where(
                PersonRow.person_id == person_id
            )
            found = session.execute(wanted).one_or_none()
        if found is None or found[0] is None or found[1] is None:
            return None
        return found[0], found[1]

    def read_again(self) -> None:
        """Load people and photos again, after a change that was made elsewhere."""
        self._known = self._load_people()

    def registered_units(self) -> Sequence[str]:
        """Ids of the units that are ours."""
        with self._store.read() as session:
            return session.scalars(
                select(Unit.unit_id).where(Unit.registered_ns.is_not(None))
            ).all()

    def units(self) -> Sequence[tuple[Unit, Assignment | None]]:
        """Return every unit with its present wearer."""
        with self._store.read() as session:
            rows = session.execute(
                select(Unit, Assignment)
                .outerjoin(
                    Assignment,
                    (Assignment.unit_id == Unit.unit_id) & Assignment.until_ns.is_(None),
                )
                .order_by(Unit.unit_id)
            )
            return [(row[0], row[1]) for row in rows]

    def unit(self, unit_id: str) -> Unit | None:
        with self._store.read() as session:
            return session.get(Unit, unit_id)

    def worn_by(self, person_id: str) -> Sequence[str]:
        with self._store.read() as session:
            return _worn_by(session, person_id)

    def worn_by_name(self) -> Sequence[tuple[str, str]]:
        """Return unit and person of the present assignments that an earlier version recorded, with
        a name.
        """
        with self._store.read() as session:
            worn = select(Assignment.unit_id, Assignment.person_id).where(
                Assignment.until_ns.is_(None), Assignment.person_name != ""
            )
            known = worn.join(PersonRow, PersonRow.person_id == Assignment.person_id)
            return [(row[0], row[1]) for row in session.execute(known)]

    def assignments(self, from_ns: int, until_ns: int) -> Sequence[Assignment]:
        """Return the assignments that were valid at some time of the window, oldest first."""
        with self._store.read() as session:
            held = select(Assignment).where(*_overlaps(from_ns, until_ns))
            return session.scalars(held.order_by(Assignment.from_ns)).all()

    def newest_assignments(self, from_ns: int, until_ns: int, limit: int) -> Sequence[Assignment]:
        """Return the assignments that were valid at some time of the window, newest first
        (``pages.newest``).
        """
        with self._store.read() as session:
            wanted = select(Assignment).where(*_overlaps(from_ns, until_ns))
            return newest(session, wanted, Assignment.from_ns, Assignment.action_id, limit)

    def _load_people(self) -> dict[str, KnownPerson]:
        with self._store.read() as session:
            return load_people(session)


def _all_on_roster(session: Session) -> Sequence[PersonRow]:
    return session.scalars(select(PersonRow).where(PersonRow.removed_ns.is_(None))).all()


def _on_roster(session: Session, person_id: str) -> PersonRow | None:
    person = session.get(PersonRow, person_id)
    return None if person is None or person.removed_ns is not None else person


def _overlaps(from_ns: int, until_ns: int) -> tuple[ColumnElement[bool], ColumnElement[bool]]:
    over = Assignment.until_ns.is_not(None) & (Assignment.until_ns <= from_ns)
    return Assignment.from_ns < until_ns, ~over


def _worn_by(session: Session, person_id: str) -> Sequence[str]:
    return session.scalars(
        select(Assignment.unit_id).where(
            Assignment.person_id == person_id, Assignment.until_ns.is_(None)
        )
    ).all()
