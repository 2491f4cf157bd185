"""Import of a list of people: which of them are new to the roster, and which are known by name."""

from __future__ import annotations

import secrets
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

from base_station.storage.db.models import PersonRow


class ListedPerson(NamedTuple):
    name: str
    crew: str | None  # None: the list has no such column, and it stays
    role: str | None


class ImportStep(NamedTuple):
    """One person of the list, as the roster has them afterwards."""

    kind: Literal["add", "change", "same", "ambiguous"]
    person_id: str
    name: str
    crew: str
    role: str


def same_name(name: str) -> str:
    """The form in which names are compared: letters' case and spaces do not count."""
    return " ".join(name.split()).casefold()


def import_steps(roster: Iterable[PersonRow], listed: Sequence[ListedPerson]) -> list[ImportStep]:
    """One step for each listed person, in their order; ambiguous where two of the roster have that
    name.  ``listed`` has no person twice.
    """
    known: dict[str, list[PersonRow]] = defaultdict(list)
    for person in roster:
        known[same_name(person.name)].append(person)
    return [_step(one, known.get(same_name(one.name), [])) for one in listed]


def _step(one: ListedPerson, known: Sequence[PersonRow]) -> ImportStep:
    if not known:
        return ImportStep("add", secrets.token_hex(8), one.name, one.crew or "", one.role or "")
    person = known[0]
    crew = person.crew if one.crew is None else one.crew
    role = person.role if one.role is None else one.role
    if len(known) > 1:
        return ImportStep("ambiguous", person.person_id, person.name, crew, role)
    is_same = (crew, role) == (person.crew, person.role)
    return ImportStep("same" if is_same else "change", person.person_id, person.name, crew, role)
