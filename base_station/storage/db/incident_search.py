"""Search of incidents by place, person, alarm and date."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import msgspec
from sqlalchemy import ColumnElement, and_, or_, select
from sqlalchemy.orm import Session

from base_station.storage.db.database import Database
from base_station.storage.db.models import IncidentRow, PersonRow, SearchTerm
from base_station.storage.db.pages import newest
from base_station.storage.db.search_index import (
    ALARM,
    AT_ONCE,
    PERSON,
    WORD,
    index,
    outdated,
    words_of,
)
from base_station.storage.db.window import EVER, Window

_LAST = "\U0010ffff"  # behind every continuation of a word's beginning


class IncidentQuery(msgspec.Struct, frozen=True):
    """Conditions on an incident, all of which must hold; empty: any incident."""

    text: str = ""  # beginnings of words: of its name and dispatch, of people, of rules of alarms
    person: str = ""  # beginnings of words of one person's name, or the id
    alarm: str = ""  # beginning of a rule's name, such as "mayday"
    opened: Window = EVER

    @property
    def is_plain(self) -> bool:
        """True if the query has only a time."""
        return not (self.text.strip() or self.person.strip() or self.alarm.strip())


class IncidentSearch:
    """Thread-safe."""

    def __init__(self, store: Database) -> None:
        self._store = store

    def find(self, query: IncidentQuery, limit: int | None = None) -> Sequence[IncidentRow]:
        """Newest first (``pages.newest``)."""
        self.index_changes()
        with self._store.read() as session:
            opened_ns = IncidentRow.opened_ns
            wanted = select(IncidentRow).where(
                opened_ns >= query.opened.from_ns, opened_ns < query.opened.until_ns
            )
            for condition in _conditions(session, query):
                wanted = wanted.where(condition)
            return newest(session, wanted, opened_ns, IncidentRow.incident_id, limit)

    def terms(self, incident_id: str) -> dict[str, set[str]]:
        """Return the terms of the query by kind: words, people and alarms (``search_index``)."""
        wanted = select(SearchTerm.kind, SearchTerm.value)
        found: dict[str, set[str]] = {}
        with self._store.read() as session:
            for kind, value in session.execute(wanted.where(SearchTerm.incident_id == incident_id)):
                found.setdefault(kind, set()).add(value)
        return found

    def index_changes(self) -> int:
        """Bring the index up to date; gives the number of incidents that were indexed."""
        with self._store.read() as session:
            changed = outdated(session)
        for begin in range(0, len(changed), AT_ONCE):
            with self._store.write(is_kept=False) as session:
                index(session, changed[begin : begin + AT_ONCE])
        return len(changed)


def _conditions(session: Session, query: IncidentQuery) -> list[ColumnElement[bool]]:
    names = _names(session) if query.text or query.person else {}
    conditions = [
        _has(
            or_(
                and_(SearchTerm.kind == WORD, _begins(word)),
                _is_one_of(_called(names, {word})),
            )
        )
        for word in sorted(words_of(query.text))
    ]
    if query.person.strip():
        people = {query.person} if query.person in names else _called(names, words_of(query.person))
        conditions.append(_has(_is_one_of(people)))
    if rule := query.alarm.strip().casefold():
        conditions.append(_has(and_(SearchTerm.kind == ALARM, _begins(rule))))
    return conditions


def _has(term: ColumnElement[bool]) -> ColumnElement[bool]:
    return IncidentRow.incident_id.in_(select(SearchTerm.incident_id).where(term))


def _begins(word: str) -> ColumnElement[bool]:
    return and_(SearchTerm.value >= word, SearchTerm.value < word + _LAST)


def _is_one_of(person_ids: Collection[str]) -> ColumnElement[bool]:
    return and_(SearchTerm.kind == PERSON, SearchTerm.value.in_(sorted(person_ids)))


def _names(session: Session) -> dict[str, set[str]]:
    """Words of the names of all who are or were on the roster, by id."""
    people = session.execute(select(PersonRow.person_id, PersonRow.name))
    return {person_id: words_of(name) for person_id, name in people}


def _called(names: dict[str, set[str]], beginnings: set[str]) -> set[str]:
    """Ids of people with a word of the name for each of the beginnings."""
    return {
        person_id
        for person_id, words in names.items()
        if beginnings and all(any(word.startswith(one) for word in words) for one in beginnings)
    }
