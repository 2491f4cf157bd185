"""Erasure of people and incidents in the tables; the audit keeps authors and kinds of actions."""

from __future__ import annotations

import re
from collections.abc import Collection

import msgspec
from sqlalchemy import ColumnElement, and_, delete, func, or_, select, update
from sqlalchemy.orm import Session

from base_station.core.erasure.erasure import (
    FOREVER_NS,
    PLACE_ACTIONS,
    Erasure,
    Wearing,
    raised_of,
)
from base_station.core.erasure.names_in_older_logs import OlderNames
from base_station.core.erasure.redaction import remaining_text, without_note, without_texts
from base_station.core.person_references import name_pattern, without_people
from base_station.core.state import ERASED_TEXT
from base_station.storage.db.models import (
    OUTDATED_NS,
    AlarmRow,
    AlarmTransition,
    ArchivedIncident,
    Assignment,
    AuditEntry,
    ImportRow,
    IncidentRow,
    IncidentTrails,
    IndexedIncident,
    PersonRow,
    PostProcessingCache,
    SearchTerm,
    SmoothedIncident,
    Tombstone,
    TrackPoint,
    UnitStart,
)
from base_station.storage.db.tombstones import PERSON
from shared.messages.station import (
    Assign,
    CheckIn,
    DoneApart,
    ImportFile,
    ResolveAlarm,
    SendCommand,
)

# Actions of the audit; the detail begins with PERSON or INCIDENT and the id.
FORGOT_PERSON, FORGOT_INCIDENT = "ForgotPerson", "ForgotIncident"
INCIDENT = "incident"
_APART, _RESOLVED, _ASSIGNED = (one.__name__ for one in (DoneApart, ResolveAlarm, Assign))
_WITH_WORDS: dict[str, type[SendCommand | CheckIn | ResolveAlarm]] = {
    one.__name__: one for one in (SendCommand, CheckIn, ResolveAlarm)
}
_NAMED = AuditEntry.action.in_(
    ("AddedPerson", "ChangedPerson")
)  # "ID", or by an older version "ID NAME"
_PLACED_NS = re.compile(r'"t_ns":(\d+)')  # the time of which a place is
_BESIDE_NS = 60 * 10**9  # what was recorded so long before and after an incident is in its copy
_ERASED_PERSON = {"person_name": ERASED_TEXT, "crew": "", "role": ""}


def forget_in(session: Session, erasure: Erasure) -> None:
    """Erase in all tables; every statement may run again."""
    for one in erasure.wearings:
        session.execute(delete(TrackPoint).where(_is_of_wearing(TrackPoint, one)))
        session.execute(delete(UnitStart).where(_is_of_wearing(UnitStart, one)))
    _delete_computed_results(session, erasure)
    _erase_alarms(session, erasure)
    _erase_audit(session, erasure)
    _erase_imports(session, erasure)
    if erasure.person_id:
        of_person = Assignment.person_id == erasure.person_id
        session.execute(update(Assignment).where(of_person).values(_ERASED_PERSON))
        session.execute(delete(PersonRow).where(PersonRow.person_id == erasure.person_id))
        session.merge(Tombstone(what=f"{PERSON}{erasure.person_id}", until_ns=None))
    else:
        for one in erasure.wearings:
            _cut_out(session, one)


def _erase_imports(session: Session, erasure: Erasure) -> None:
    """Erase imports of a forgotten incident; of the others, people in the names of files."""
    if erasure.incident_id:
        session.execute(delete(ImportRow).where(ImportRow.incident_id == erasure.incident_id))
        of_it = AuditEntry.detail.contains(f'"{erasure.incident_id}"', autoescape=True)
        is_import = AuditEntry.action == ImportFile.__name__
        session.execute(
            update(AuditEntry)
            .where(is_import, of_it)
            .values(detail=erased_detail(erasure.incident_id))
        )
        return
    names = _Names(erasure, erasure.person_ids)
    for row in session.scalars(select(ImportRow)):
        row.file_name = names.erased(row.file_name)


def _delete_computed_results(session: Session, erasure: Erasure) -> None:
    """Delete results that were computed from incidents of an erased person; they can be computed
    again.
    """
    _outdate_copies(session, erasure)
    spans = [(one.from_ns, one.until_ns) for one in erasure.wearings]
    for incident in session.scalars(select(IncidentRow)).all():
        until_ns = incident.closed_ns or FOREVER_NS
        if any(begin < until_ns and end > incident.opened_ns for begin, end in spans):
            for table in (
                *(SmoothedIncident, IncidentTrails, PostProcessingCache),
                *(SearchTerm, IndexedIncident),
            ):
                session.execute(delete(table).where(table.incident_id == incident.incident_id))


def _outdate_copies(session: Session, erasure: Erasure) -> None:
    """Mark copies in archives as outdated that may have the people: of a person all of them, as any
    may mention the person; of an incident those of its time.
    """
    outdated = update(ArchivedIncident).values(known_ns=OUTDATED_NS)
    if not erasure.person_id:
        beside = select(IncidentRow.incident_id).where(
            IncidentRow.opened_ns < erasure.until_ns + _BESIDE_NS,
            func.coalesce(IncidentRow.closed_ns, FOREVER_NS) > erasure.from_ns - _BESIDE_NS,
        )
        outdated = outdated.where(ArchivedIncident.incident_id.in_(beside))
    session.execute(outdated)


def known_names(session: Session, person_id: str) -> set[str]:
    """Names of a person in the tables, present and former."""
    names = set(session.scalars(select(PersonRow.name).where(PersonRow.person_id == person_id)))
    names |= set(
        session.scalars(select(Assignment.person_name).where(Assignment.person_id == person_id))
    )
    mine = AuditEntry.detail.startswith(f"{person_id} ", autoescape=True)
    details = session.scalars(select(AuditEntry.detail).where(_NAMED, mine))
    names |= {detail.removeprefix(f"{person_id} ") for detail in details}
    return names - {ERASED_TEXT, ""}


def wearings_of(session: Session, person_id: str, until_ns: int) -> list[Wearing]:
    """Times in which the person wore a unit, before a station time."""
    worn = select(Assignment).where(
        Assignment.person_id == person_id, Assignment.from_ns < until_ns
    )
    return [
        Wearing(one.unit_id, one.from_ns, min(one.until_ns or until_ns, until_ns))
        for one in session.scalars(worn)
    ]


def erased_detail(incident_id: str) -> str:
    """Return the detail of an audit entry whose content is erased."""
    return f"{ERASED_TEXT} {incident_id}".rstrip()


def erased_incidents(session: Session) -> dict[str, int]:
    """Ids of the incidents that were erased here, each with the station time of the last time."""
    erasures = select(AuditEntry.detail, AuditEntry.t_ns).where(
        AuditEntry.action == FORGOT_INCIDENT
    )
    return {
        detail.removeprefix(f"{INCIDENT} ").partition(":")[0]: t_ns
        for detail, t_ns in session.execute(erasures.order_by(AuditEntry.t_ns))
    }


def incidents_to_erase(session: Session, closed_before_ns: int) -> list[tuple[str, int]]:
    """Ids of incidents that were closed before then, the first closed first, each with the time of
    its newest late data; without those that are erased with all late data.
    """
    erased_ns = erased_incidents(session)
    closed = (
        select(IncidentRow.incident_id, IncidentRow.late_data_ns)
        .where(IncidentRow.closed_ns < closed_before_ns)
        .order_by(IncidentRow.closed_ns)
    )
    return [
        (incident_id, late_data_ns)
        for incident_id, late_data_ns in session.execute(closed)
        if incident_id not in erased_ns or late_data_ns > erased_ns[incident_id]
    ]


def ids_of(session: Session, name: str) -> set[str]:
    """Ids of people of that name, now or before, whether or not they are on the roster still."""
    ids = set(session.scalars(select(PersonRow.person_id).where(PersonRow.name == name)))
    worn = Assignment.person_name == name
    ids |= set(session.scalars(select(Assignment.person_id).where(worn)))
    theirs = AuditEntry.detail.endswith(f" {name}", autoescape=True)
    details = session.scalars(select(AuditEntry.detail).where(_NAMED, theirs))
    return ids | {one.partition(" ")[0] for one in details if one.partition(" ")[2] == name}


def _is_of_wearing(table: type[TrackPoint | UnitStart], one: Wearing) -> ColumnElement[bool]:
    return and_(table.unit_id == one.unit_id, table.t_ns >= one.from_ns, table.t_ns < one.until_ns)


def _erase_alarms(session: Session, erasure: Erasure) -> None:
    for alarm in session.scalars(select(AlarmRow)):
        raised = alarm.unit_id, alarm.raised_ns
        covered = erasure.covers(*raised)
        if covered or erasure.is_about(*raised):
            # Its earlier texts may name others than its present ones.
            people = erasure.person_ids if covered else erasure.people_in_alarm(*raised)
            _rewrite_alarm(session, alarm, _Names(erasure, people), covered)


def _rewrite_alarm(session: Session, alarm: AlarmRow, names: _Names, covered: bool) -> None:
    changes = session.scalars(
        select(AlarmTransition).where(AlarmTransition.alarm_id == alarm.alarm_id)
    ).all()
    rows: list[AlarmRow | AlarmTransition] = [alarm, *changes]
    for row in rows:
        row.text = ERASED_TEXT if covered else names.erased(row.text)
        row.by = names.erased(without_note(row.by) if covered else row.by)
        row.code = "" if covered else row.code
        row.parameters = "{}" if covered else names.erased(row.parameters)
        if row.note:
            row.note = ERASED_TEXT if covered else names.erased(row.note)


def _erase_audit(session: Session, erasure: Erasure) -> None:
    """Erase names, texts and places in the audit; kind, time and author of an action stay."""
    inside = and_(AuditEntry.t_ns >= erasure.from_ns, AuditEntry.t_ns < erasure.until_ns)
    for entry in session.scalars(select(AuditEntry).where(inside, AuditEntry.action != _APART)):
        names = _Names(erasure, erasure.people_at(entry.t_ns))
        entry.detail = names.erased(_without_texts(entry, erasure))
        if entry.action == _ASSIGNED:
            entry.detail = _without_wearer(entry, erasure)
    places = AuditEntry.action.in_(PLACE_ACTIONS), AuditEntry.t_ns >= erasure.from_ns
    for entry in session.scalars(select(AuditEntry).where(*places)):
        if _is_place_of(entry, erasure):
            entry.detail = erased_detail(erasure.incident_id)
    for entry in session.scalars(select(AuditEntry).where(AuditEntry.action == _RESOLVED)):
        raised = _alarm_raised(entry)
        if raised is not None and erasure.is_about(*raised):
            names = _Names(erasure, erasure.people_in_alarm(*raised))
            entry.detail = names.erased(entry.detail)
    for entry in session.scalars(select(AuditEntry).where(AuditEntry.action == _APART)):
        entry.detail = _remaining_detail(entry, erasure)
    mine = AuditEntry.detail.startswith(f"{erasure.person_id} ", autoescape=True)
    for entry in session.scalars(select(AuditEntry).where(_NAMED, mine)):
        entry.detail = f"{erasure.person_id} {ERASED_TEXT}"


class _Names:
    """Names and references that are removed from texts."""

    def __init__(self, erasure: Erasure, person_ids: Collection[str]) -> None:
        self._older = OlderNames(erasure.names)
        self._person_ids = person_ids

    def erased(self, text: str) -> str:
        older = self._older.erased_in_json(text)
        return without_people(older, self._person_ids, ERASED_TEXT)


def _is_place_of(entry: AuditEntry, erasure: Erasure) -> bool:
    """True if it has the place of a unit at a time when an erased person wore it."""
    about = _PLACED_NS.search(entry.detail)
    times_ns = {entry.t_ns, int(about[1]) if about else 0} - {0}
    units = [
        unit_id
        for unit_id in erasure.unit_ids
        if any(erasure.covers(unit_id, one) for one in times_ns)
    ]
    return name_pattern(units).search(entry.detail) is not None


def _without_texts(entry: AuditEntry, erasure: Erasure) -> str:
    kind = _WITH_WORDS.get(entry.action)
    if kind is None:
        return entry.detail
    try:
        done = msgspec.json.decode(entry.detail, type=kind)
    except msgspec.DecodeError:  # empty afterwards
        return entry.detail
    left = without_texts(entry.t_ns, done, erasure)
    return entry.detail if left is done else msgspec.json.encode(left).decode()


def _without_wearer(entry: AuditEntry, erasure: Erasure) -> str:
    """Assignment without its wearer: in a small station crew and role are as good as a name."""
    try:
        worn = msgspec.json.decode(entry.detail, type=Assign)
    except msgspec.DecodeError:  # empty afterwards
        return entry.detail
    if erasure.incident_id:
        if not erasure.covers(worn.unit_id, entry.t_ns):
            return entry.detail
        worn = msgspec.structs.replace(worn, person_id=ERASED_TEXT)
    elif worn.person_id != erasure.person_id:
        return entry.detail
    return msgspec.json.encode(msgspec.structs.replace(worn, **_ERASED_PERSON)).decode()


def _alarm_raised(entry: AuditEntry) -> tuple[str, int] | None:
    """Unit of the alarm that was resolved, and when that was raised."""
    try:
        noted = msgspec.json.decode(entry.detail, type=ResolveAlarm)
    except msgspec.DecodeError:  # empty afterwards
        return None
    return raised_of(noted.alarm_id)


def _remaining_detail(entry: AuditEntry, erasure: Erasure) -> str:
    """Detail of an action at the other station, which may be recorded long after its time."""
    try:
        done = msgspec.json.decode(entry.detail, type=DoneApart)
    except msgspec.DecodeError:  # empty afterwards, or unreadable
        return ERASED_TEXT
    left = remaining_text(done, entry.t_ns, erasure, OlderNames(erasure.names))
    return msgspec.json.encode(msgspec.structs.replace(done, what=left)).decode()


def _cut_out(session: Session, one: Wearing) -> None:
    """Remove the wearer of the unit in that time."""
    overlapping = select(Assignment).where(
        Assignment.unit_id == one.unit_id,
        Assignment.from_ns < one.until_ns,
        or_(Assignment.until_ns.is_(None), Assignment.until_ns > one.from_ns),
    )
    for row in session.scalars(overlapping).all():
        goes_on = row.until_ns is None or row.until_ns > one.until_ns
        if goes_on and row.from_ns < one.from_ns:
            columns = {
                column.name: getattr(row, column.name) for column in Assignment.__table__.columns
            }
            after = {"action_id": f"{row.action_id}-after", "from_ns": one.until_ns}
            session.add(Assignment(**(columns | after)))
            row.until_ns = one.from_ns
        elif goes_on:
            row.from_ns = one.until_ns
        elif row.from_ns < one.from_ns:
            row.until_ns = one.from_ns
        else:
            session.delete(row)
