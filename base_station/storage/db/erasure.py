"""Takes what is to be forgotten of people out of the tables; the audit keeps who did what."""

from __future__ import annotations

import msgspec
from sqlalchemy import ColumnElement, and_, delete, or_, select, update
from sqlalchemy.orm import Session

from base_station.core.erasure.erasure import FOREVER_NS, PLACE_ACTIONS, Erasure, Wearing
from base_station.core.erasure.names_in_older_logs import OlderNames
from base_station.core.erasure.redaction import remaining_text, without_note, without_texts
from base_station.core.person_references import name_pattern, without_people
from base_station.core.state import ERASED_TEXT
from base_station.storage.db.models import (
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

_APART, _RESOLVED, _ASSIGNED = (one.__name__ for one in (DoneApart, ResolveAlarm, Assign))
_WITH_WORDS: dict[str, type[SendCommand | CheckIn | ResolveAlarm]] = {
    one.__name__: one for one in (SendCommand, CheckIn, ResolveAlarm)
}
_NAMED = AuditEntry.action.in_(
    ("AddedPerson", "ChangedPerson")
)  # "ID", or by an older version "ID NAME"
_NOBODY = {"person_name": ERASED_TEXT, "crew": "", "role": ""}


def forget_in(session: Session, erasure: Erasure) -> None:
    """Every statement may run again."""
    for one in erasure.wearings:
        session.execute(delete(TrackPoint).where(_within(TrackPoint, one)))
        session.execute(delete(UnitStart).where(_within(UnitStart, one)))
    _looked_back(session, erasure)
    _alarms(session, erasure)
    _audit(session, erasure)
    _imports(session, erasure)
    if erasure.person_id:
        of_person = Assignment.person_id == erasure.person_id
        session.execute(update(Assignment).where(of_person).values(_NOBODY))
        session.execute(delete(PersonRow).where(PersonRow.person_id == erasure.person_id))
        session.merge(Tombstone(what=f"{PERSON}{erasure.person_id}", until_ns=None))
    else:
        _cut_out(session, erasure)


def _imports(session: Session, erasure: Erasure) -> None:
    """Erase imports of a forgotten incident; of the others, people in the names of files."""
    if erasure.incident_id:
        session.execute(delete(ImportRow).where(ImportRow.incident_id == erasure.incident_id))
        of_it = AuditEntry.detail.contains(f'"{erasure.incident_id}"', autoescape=True)
        is_import = AuditEntry.action == ImportFile.__name__
        session.execute(update(AuditEntry).where(is_import, of_it).values(detail=ERASED_TEXT))
        return
    for row in session.scalars(select(ImportRow)):
        row.file_name = _without_names(row.file_name, erasure)


def _looked_back(session: Session, erasure: Erasure) -> None:
    """What was worked out of incidents in which anybody is forgotten; it can be again."""
    spans = [(one.from_ns, one.until_ns) for one in erasure.wearings]
    for incident in session.scalars(select(IncidentRow)).all():
        until_ns = incident.closed_ns or FOREVER_NS
        if any(begin < until_ns and end > incident.opened_ns for begin, end in spans):
            for table in (
                *(SmoothedIncident, IncidentTrails, PostProcessingCache),
                *(SearchTerm, IndexedIncident),
            ):
                session.execute(delete(table).where(table.incident_id == incident.incident_id))
            session.execute(  # its copy is made again
                update(ArchivedIncident)
                .where(ArchivedIncident.incident_id == incident.incident_id)
                .values(known_ns=0)
            )


def known_names(session: Session, person_id: str) -> set[str]:
    """How the tables call a person, now and before."""
    names = set(session.scalars(select(PersonRow.name).where(PersonRow.person_id == person_id)))
    names |= set(
        session.scalars(select(Assignment.person_name).where(Assignment.person_id == person_id))
    )
    mine = AuditEntry.detail.startswith(f"{person_id} ", autoescape=True)
    details = session.scalars(select(AuditEntry.detail).where(_NAMED, mine))
    names |= {detail.removeprefix(f"{person_id} ") for detail in details}
    return names - {ERASED_TEXT, ""}


def ids_of(session: Session, name: str) -> set[str]:
    """Ids of people of that name, now or before, whether or not they are on the roster still."""
    ids = set(session.scalars(select(PersonRow.person_id).where(PersonRow.name == name)))
    worn = Assignment.person_name == name
    ids |= set(session.scalars(select(Assignment.person_id).where(worn)))
    theirs = AuditEntry.detail.endswith(f" {name}", autoescape=True)
    details = session.scalars(select(AuditEntry.detail).where(_NAMED, theirs))
    return ids | {one.partition(" ")[0] for one in details if one.partition(" ")[2] == name}


def _within(table: type[TrackPoint | UnitStart], one: Wearing) -> ColumnElement[bool]:
    return and_(table.unit_id == one.unit_id, table.t_ns >= one.from_ns, table.t_ns < one.until_ns)


def _alarms(session: Session, erasure: Erasure) -> None:
    for alarm in session.scalars(select(AlarmRow)):
        covered = erasure.covers(alarm.unit_id, alarm.raised_ns)
        if covered or erasure.is_about(
            alarm.unit_id, alarm.raised_ns
        ):  # what it said before may name others than what it says now
            _rewrite_alarm(session, alarm, erasure, covered)


def _rewrite_alarm(session: Session, alarm: AlarmRow, erasure: Erasure, covered: bool) -> None:
    changes = session.scalars(
        select(AlarmTransition).where(AlarmTransition.alarm_id == alarm.alarm_id)
    ).all()
    rows: list[AlarmRow | AlarmTransition] = [alarm, *changes]
    for row in rows:
        row.text = ERASED_TEXT if covered else _without_names(row.text, erasure)
        row.by = _without_names(without_note(row.by) if covered else row.by, erasure)
        row.code = "" if covered else row.code
        row.parameters = "{}" if covered else _without_names(row.parameters, erasure)
        if row.note:
            row.note = ERASED_TEXT if covered else _without_names(row.note, erasure)


def _audit(session: Session, erasure: Erasure) -> None:
    """Names, words and places go; that it was done, when and by whom stays."""
    units = name_pattern(erasure.unit_ids)
    inside = and_(AuditEntry.t_ns >= erasure.from_ns, AuditEntry.t_ns < erasure.until_ns)
    for entry in session.scalars(select(AuditEntry).where(inside, AuditEntry.action != _APART)):
        entry.detail = _without_names(_without_texts(entry, erasure), erasure)
        if entry.action == _ASSIGNED:
            entry.detail = _nobodys(entry.detail, erasure)
        about = units.search(entry.detail) if entry.action in PLACE_ACTIONS else None
        if about is not None:
            entry.detail = ERASED_TEXT
    for entry in session.scalars(select(AuditEntry).where(AuditEntry.action == _RESOLVED)):
        if _is_about(entry, erasure):
            entry.detail = _without_names(entry.detail, erasure)
    for entry in session.scalars(select(AuditEntry).where(AuditEntry.action == _APART)):
        entry.detail = _apart(entry, erasure)
    mine = AuditEntry.detail.startswith(f"{erasure.person_id} ", autoescape=True)
    for entry in session.scalars(select(AuditEntry).where(_NAMED, mine)):
        entry.detail = f"{erasure.person_id} {ERASED_TEXT}"


def _without_names(text: str, erasure: Erasure) -> str:
    older = OlderNames(erasure.names).erased_in_json(text)
    return without_people(older, erasure.person_ids, ERASED_TEXT)


def _without_texts(entry: AuditEntry, erasure: Erasure) -> str:
    kind = _WITH_WORDS.get(entry.action)
    if kind is None:
        return entry.detail
    try:
        done = msgspec.json.decode(entry.detail, type=kind)
    except msgspec.DecodeError:  # nothing is left of it
        return entry.detail
    left = without_texts(entry.t_ns, done, erasure)
    return entry.detail if left is done else msgspec.json.encode(left).decode()


def _nobodys(detail: str, erasure: Erasure) -> str:
    """Assignment without its wearer: in a small station crew and role are as good as a name."""
    try:
        worn = msgspec.json.decode(detail, type=Assign)
    except msgspec.DecodeError:  # nothing is left of it
        return detail
    if erasure.person_id not in ("", worn.person_id):
        return detail
    nobody = msgspec.structs.replace(worn, **_NOBODY)
    if erasure.incident_id:
        nobody = msgspec.structs.replace(nobody, person_id=ERASED_TEXT)
    return msgspec.json.encode(nobody).decode()


def _is_about(entry: AuditEntry, erasure: Erasure) -> bool:
    try:
        noted = msgspec.json.decode(entry.detail, type=ResolveAlarm)
    except msgspec.DecodeError:  # nothing is left of it
        return False
    return erasure.is_about_alarm(noted.alarm_id)


def _apart(entry: AuditEntry, erasure: Erasure) -> str:
    """What was done at the other station may have been written down long after it was done."""
    try:
        done = msgspec.json.decode(entry.detail, type=DoneApart)
    except msgspec.DecodeError:  # nothing is left of it, or nobody knows what it says
        return ERASED_TEXT
    left = remaining_text(done, entry.t_ns, erasure, OlderNames(erasure.names))
    return msgspec.json.encode(msgspec.structs.replace(done, what=left)).decode()


def _cut_out(session: Session, erasure: Erasure) -> None:
    """Nobody wears anything in the time of the incident."""
    from_ns, until_ns = erasure.from_ns, erasure.until_ns
    overlapping = select(Assignment).where(
        Assignment.from_ns < until_ns,
        or_(Assignment.until_ns.is_(None), Assignment.until_ns > from_ns),
    )
    for row in session.scalars(overlapping).all():
        goes_on = row.until_ns is None or row.until_ns > until_ns
        if goes_on and row.from_ns < from_ns:
            columns = {
                column.name: getattr(row, column.name) for column in Assignment.__table__.columns
            }
            after = {"action_id": f"{row.action_id}-after", "from_ns": until_ns}
            session.add(Assignment(**(columns | after)))
            row.until_ns = from_ns
        elif goes_on:
            row.from_ns = until_ns
        elif row.from_ns < from_ns:
            row.until_ns = from_ns
        else:
            session.delete(row)
