"""Directory of people by the person ids of the log: name, crew, role and photo, from the database.
It is in memory, because the engine's thread reads it whenever a person is shown.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec
from sqlalchemy import select
from sqlalchemy.orm import Session

from base_station.core.person_references import with_names
from base_station.core.state import ERASED_TEXT
from base_station.storage.db.models import Assignment, PersonRow, Tombstone
from base_station.storage.db.tombstones import PERSON

_ID_SHOWN = 8  # digits of an id that has no name


class KnownPerson(msgspec.Struct, frozen=True):
    """Person as shown now, with the present name."""

    name: str
    crew: str = ""
    role: str = ""
    photo_url: str | None = None


PersonLookup = Callable[[str], KnownPerson]  # by person id; every id gives a person
FORGOTTEN = KnownPerson(ERASED_TEXT)


def person_lookup(known: Mapping[str, KnownPerson]) -> PersonLookup:
    """Return a lookup of people; a person whose name is lost is shown by the id."""

    def look_up(person_id: str) -> KnownPerson:
        return known.get(person_id) or KnownPerson(f"person {person_id[:_ID_SHOWN]}")

    return look_up


def shown_text(text: str, people: PersonLookup) -> str:
    """Return a text of the log with names in place of references."""
    return with_names(text, lambda person_id: people(person_id).name)


def shown_wearer(assignment: Assignment, people: PersonLookup) -> KnownPerson:
    """Wearer of a unit; a log of an earlier version has the name of then."""
    known = people(assignment.person_id)
    if not assignment.person_name:
        return known
    return KnownPerson(assignment.person_name, assignment.crew, assignment.role, known.photo_url)


def load_people(session: Session) -> dict[str, KnownPerson]:
    """People on the roster, those who were removed from it, and those who were forgotten."""
    gone = session.scalars(select(Tombstone.what).where(Tombstone.what.startswith(PERSON)))
    known = {what.removeprefix(PERSON): FORGOTTEN for what in gone}
    return known | {one.person_id: known_person(one) for one in session.scalars(select(PersonRow))}


def known_person(person: PersonRow) -> KnownPerson:
    url = _photo_url(person.person_id, person.photo_hash) if person.photo_hash else None
    return KnownPerson(person.name, person.crew, person.role, url)


def _photo_url(person_id: str, photo_hash: str) -> str:
    return f"/api/v1/people/{person_id}/photo?v={photo_hash}"
