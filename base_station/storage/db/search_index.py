"""Index of the search for incidents: words of the place, people, and alarms.  Each search first
updates it by the changes of the other tables.  A person is in it by the id, whose name is in the
roster alone.
"""

from __future__ import annotations

import heapq
import re
import unicodedata
from bisect import bisect_left
from collections.abc import Iterator, Sequence

import msgspec
from sqlalchemy import ColumnElement, and_, case, delete, exists, func, insert, or_, select
from sqlalchemy.orm import Session, aliased

from base_station.core.person_references import references_in, with_names
from base_station.storage.db.members import members_of
from base_station.storage.db.models import (
    AlarmRow,
    Assignment,
    DispatchRow,
    ImportRow,
    IncidentMember,
    IncidentRow,
    IndexedIncident,
    SearchTerm,
)
from base_station.storage.db.window import FOREVER_NS
from shared.messages.station import NoteDispatch

WORD, PERSON, ALARM = "word", "person", "alarm"
AT_ONCE = 200  # incidents
_WORDS = re.compile(r"\w+")
_REPORTS = msgspec.json.Decoder(NoteDispatch)
_Term = tuple[str, str, str]  # incident, kind, value


def words_of(text: str) -> set[str]:
    """Return the words of a text for comparison: without case and accents."""
    parts = unicodedata.normalize("NFKD", text.casefold())
    plain = "".join(part for part in parts if not unicodedata.combining(part))
    return set(_WORDS.findall(plain))


def newest_known_ns() -> ColumnElement[int]:
    """Station time of the newest that is known of an incident; 0 while it is open."""
    known_ns: ColumnElement[int] = func.coalesce(IncidentRow.closed_ns, 0)
    imported_ns = (
        select(func.coalesce(func.max(ImportRow.t_ns), 0))
        .where(ImportRow.incident_id == IncidentRow.incident_id)
        .correlate(IncidentRow)
        .scalar_subquery()
    )
    for later_ns in (IncidentRow.late_data_ns, imported_ns):
        known_ns = case((later_ns > known_ns, later_ns), else_=known_ns)
    return case((IncidentRow.closed_ns.is_(None), 0), else_=known_ns)


def outdated(session: Session) -> Sequence[str]:
    """Incidents that are open, or of which more is known than the index has."""
    is_indexed = exists().where(
        IndexedIncident.incident_id == IncidentRow.incident_id,
        IndexedIncident.known_ns == newest_known_ns(),
        IndexedIncident.known_ns != 0,
    )
    wanted = select(IncidentRow.incident_id).where(~is_indexed)
    return session.scalars(wanted.order_by(IncidentRow.opened_ns)).all()


def index(session: Session, incident_ids: Sequence[str]) -> None:
    """Index these incidents anew: at most ``AT_ONCE``, for others wait for the transaction."""
    for table in (SearchTerm, IndexedIncident):
        session.execute(delete(table).where(table.incident_id.in_(incident_ids)))
    known = select(IncidentRow.incident_id, newest_known_ns())
    session.execute(
        insert(IndexedIncident).from_select(
            ["incident_id", "known_ns"], known.where(IncidentRow.incident_id.in_(incident_ids))
        )
    )
    found = _texts, _people, _alarms
    terms = {term for terms_of in found for term in terms_of(session, incident_ids)}
    rows = [
        {"incident_id": incident_id, "kind": kind, "value": value}
        for incident_id, kind, value in sorted(terms)
    ]
    if rows:
        session.connection().execute(insert(SearchTerm), rows)  # many: without objects


def _texts(session: Session, incident_ids: Sequence[str]) -> Iterator[_Term]:
    """Return words of names and dispatches, and the people that these mention."""
    wanted = select(IncidentRow.incident_id, IncidentRow.name, DispatchRow.report).join_from(
        IncidentRow, DispatchRow, DispatchRow.number == IncidentRow.dispatch_number, isouter=True
    )
    for incident_id, name, encoded in session.execute(
        wanted.where(IncidentRow.incident_id.in_(incident_ids))
    ):
        yield from ((incident_id, PERSON, person_id) for person_id in references_in(name))
        texts = [with_names(name, lambda _: "")]
        if encoded is not None:
            report = _REPORTS.decode(encoded)
            texts += [report.number, report.address, report.type]
        yield from ((incident_id, WORD, word) for text in texts for word in words_of(text))


def _people(session: Session, incident_ids: Sequence[str]) -> Iterator[_Term]:
    """People who wore a unit in them."""
    # A unit has one wearer at a time: the wearer when its membership began, and later ones.  Else
    # every earlier assignment would be gone through.
    before = aliased(Assignment)
    first_ns = (
        select(func.max(before.from_ns))
        .where(before.unit_id == IncidentMember.unit_id, before.from_ns <= IncidentMember.from_ns)
        .scalar_subquery()
    )
    during = and_(
        Assignment.unit_id == IncidentMember.unit_id,
        Assignment.from_ns >= func.coalesce(first_ns, 0),
        Assignment.from_ns < func.coalesce(IncidentMember.until_ns, FOREVER_NS),
        func.coalesce(Assignment.until_ns, FOREVER_NS) > IncidentMember.from_ns,
    )
    members = (
        select(IncidentMember.incident_id, Assignment.person_id)
        .join(Assignment, during)
        .where(IncidentMember.incident_id.in_(incident_ids), Assignment.person_id != "")
        .distinct()
    )
    for incident_id, person_id in session.execute(members):
        yield incident_id, PERSON, person_id
    yield from _all_wearers(session, incident_ids)


def _all_wearers(session: Session, incident_ids: Sequence[str]) -> Iterator[_Term]:
    """People who wore a unit meanwhile, of incidents of an earlier version, which had all units."""
    incidents = session.execute(
        select(IncidentRow.incident_id, IncidentRow.opened_ns, IncidentRow.closed_ns)
        .where(IncidentRow.incident_id.in_(incident_ids), ~IncidentRow.has_members)
        .order_by(IncidentRow.opened_ns)
    ).all()
    if not incidents:
        return
    last_ns = max(one.closed_ns or FOREVER_NS for one in incidents)
    worn = session.execute(
        select(Assignment.from_ns, Assignment.until_ns, Assignment.person_id)
        .where(
            Assignment.from_ns < last_ns,
            or_(Assignment.until_ns.is_(None), Assignment.until_ns > incidents[0].opened_ns),
            Assignment.person_id != "",
        )
        .order_by(Assignment.from_ns)
    ).all()
    begun: list[tuple[int, int, str]] = []  # until, from, person: a heap of those not yet over
    count = 0
    for incident_id, opened_ns, closed_ns in incidents:
        end_ns = closed_ns or FOREVER_NS
        while count < len(worn) and worn[count].from_ns < end_ns:
            from_ns, until_ns, person_id = worn[count]
            heapq.heappush(begun, (until_ns or FOREVER_NS, from_ns, person_id))
            count += 1
        while begun and begun[0][0] <= opened_ns:
            heapq.heappop(begun)
        for _, from_ns, person_id in begun:
            if from_ns < end_ns:
                yield incident_id, PERSON, person_id


def _alarms(session: Session, incident_ids: Sequence[str]) -> Iterator[_Term]:
    """Rules that raised an alarm of a member, or of the station, while they were open."""
    of_these = IncidentRow.incident_id.in_(incident_ids)
    incidents = session.scalars(select(IncidentRow).where(of_these)).all()
    windows = {one.incident_id: members_of(session, one) for one in incidents}
    first_ns = min((one.window.from_ns for one in windows.values()), default=0)
    last_ns = max((one.window.until_ns for one in windows.values()), default=0)
    raised = session.execute(  # once for all: a search for each would be as long as the table
        select(AlarmRow.raised_ns, AlarmRow.unit_id, AlarmRow.rule)
        .where(AlarmRow.raised_ns >= first_ns, AlarmRow.raised_ns < last_ns)
        .order_by(AlarmRow.raised_ns)
    ).all()
    times_ns = [one.raised_ns for one in raised]
    for incident_id, members in windows.items():
        begin = bisect_left(times_ns, members.window.from_ns)
        end = bisect_left(times_ns, members.window.until_ns)
        for raised_ns, unit_id, rule in raised[begin:end]:
            if not unit_id or members.has(unit_id, raised_ns):
                yield incident_id, ALARM, rule
                yield from ((incident_id, WORD, word) for word in words_of(rule))
