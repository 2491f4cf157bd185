"""Statements that bring one projection into the tables.  Every one of them may run again."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
from sqlalchemy import ColumnElement, delete, func, select, update
from sqlalchemy.orm import Session

from base_station.core.erasure.erasure import is_inserted
from base_station.core.person_references import reference_to
from base_station.core.units.worn_sensors import worn_sensors
from base_station.storage.db.models import (
    AlarmRow,
    AlarmTransition,
    AnchorRow,
    ArchivedIncident,
    Assignment,
    AuditEntry,
    DispatchRow,
    ImportRow,
    IncidentMember,
    IncidentRow,
    PlanRow,
    TrackPoint,
    Unit,
    UnitStart,
)
from base_station.storage.db.track_partitions import make_partitions
from base_station.storage.db.upserts import Insert, insert_into, is_on_server, later_of
from base_station.storage.projection import Projection
from shared.clock import NS_PER_S
from shared.messages import AlarmChange, FusedPosition, OperatorAction, UnitDescription
from shared.messages.pins import RemovePin, SetMeeting, SetPin, StartTogether
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CloseIncident,
    ImportFile,
    NoteDispatch,
    OpenIncident,
    RegisterUnit,
    RemoveImport,
    ReportProblem,
    ResolveAlarm,
    SetAnchor,
    SetPlan,
    SetStart,
    Unassign,
)

_NEW_UNIT = {
    "label": "",
    "registered_ns": None,
    "last_heard_ns": None,
    "software_version": "",
    "source": "",
    "sensor_name": "",
    "tracker": "",
    "calibration": "",
    "has_gps": False,
    "sensors": "[]",
}


def project_into(session: Session, projections: Sequence[Projection]) -> int:
    """Write projections in their order; gives how many places no table can hold.

    Places of units and times of their last messages make up nearly all of it and depend on nothing
    else, so these go in at the end, in one go.
    """
    tracks: list[FusedPosition] = []
    last_messages: dict[str, int] = {}
    for projection in projections:
        for action in projection.actions:
            if not (isinstance(action.action, ReportProblem) or is_inserted(action)):
                # Those two are no person's doing.
                _audit(session, action.header.t_utc_ns, action)
            _project_action(session, action.header.t_utc_ns, action)
        _memberships(session, projection)
        for change in projection.alarms:
            _alarm(session, change)
        for description in projection.descriptions:
            _unit(session, description.header.unit_id, **_described(description))
        if projection.news:
            touched = IncidentRow.incident_id.in_(projection.news)
            session.execute(update(IncidentRow).where(touched).values(late_data_ns=projection.t_ns))
        tracks += projection.tracks
        last_messages.update(projection.last_messages)
    left_out = _tracks(session, tracks)
    _last_messages(session, last_messages)
    return left_out


def _project_action(session: Session, t_ns: int, done: OperatorAction) -> None:
    key = {"action_id": done.action_id, "t_ns": t_ns}
    match done.action:
        case OpenIncident(incident_id=incident_id, name=name, dispatch_number=number):
            _add(
                session, IncidentRow, incident_id=incident_id, name=name, opened_ns=t_ns,
                opened_by=done.by, closed_ns=None, closed_by="", dispatch_number=number,
            )  # fmt: skip
        case NoteDispatch() as report:
            _dispatch(session, report)
        case CloseIncident(incident_id=incident_id):
            session.execute(
                update(IncidentRow)
                .where(IncidentRow.incident_id == incident_id, IncidentRow.closed_ns.is_(None))
                .values(closed_ns=t_ns, closed_by=done.by)
            )
        case Assign() as assign:
            _end_assignments(session, t_ns, Assignment.unit_id == assign.unit_id)
            _end_assignments(session, t_ns, Assignment.person_id == assign.person_id)
            columns = {name: getattr(assign, name) for name in _ASSIGNED_COLUMNS}
            _add(
                session, Assignment, action_id=done.action_id, from_ns=t_ns, until_ns=None,
                **columns,
            )  # fmt: skip
        case Unassign(unit_id=unit_id):
            _end_assignments(session, t_ns, Assignment.unit_id == unit_id)
        case RegisterUnit(unit_id=unit_id, label=label):
            _unit(session, unit_id, label=label, registered_ns=t_ns)
        case SetAnchor() as anchor:
            _add(session, AnchorRow, **key, **msgspec.structs.asdict(anchor))
        case SetPlan(geojson=geojson, incident_id=incident_id):
            _add(session, PlanRow, **key, geojson=geojson, incident_id=incident_id)
        case SetStart() as start:
            columns = {name: getattr(start, name) for name in _START_COLUMNS}
            _add(session, UnitStart, **key, **columns)
        case ImportFile() | RemoveImport():
            _import(session, t_ns, done.by, done.action)
        case AcknowledgeAlarm() | ResolveAlarm() | ReportProblem():
            pass  # its changes of alarms come with the same step
        case _:
            pass  # the audit and the log have it, or the stored one was rewritten before


def _import(session: Session, t_ns: int, by: str, action: ImportFile | RemoveImport) -> None:
    if isinstance(action, ImportFile):
        _add(session, ImportRow, t_ns=t_ns, by=by, **msgspec.structs.asdict(action))
        return
    is_it = ImportRow.incident_id == action.incident_id, ImportRow.import_id == action.import_id
    session.execute(delete(ImportRow).where(*is_it))
    session.execute(  # its copy in an archive is made again, without it
        update(ArchivedIncident)
        .where(ArchivedIncident.incident_id == action.incident_id)
        .values(known_ns=0)
    )


def _dispatch(session: Session, report: NoteDispatch) -> None:
    columns = {
        "updated_ns": report.updated_ns,
        "report": msgspec.json.encode(report).decode(),
    }
    session.execute(
        insert_into(session, DispatchRow)
        .values(number=report.number, **columns)
        .on_conflict_do_update(
            index_elements=[DispatchRow.number],
            set_=columns,
            where=DispatchRow.updated_ns <= report.updated_ns,
        )
    )


def _memberships(session: Session, projection: Projection) -> None:
    """In the order of time: a unit leaves the incident that it was in as it comes to the next."""
    for incident_id, site_id in projection.opened:
        row = update(IncidentRow).where(IncidentRow.incident_id == incident_id)
        session.execute(row.values(site_id=site_id, has_members=True))
    for unit_id, incident_id, t_ns in projection.memberships:
        session.execute(
            update(IncidentMember)
            .where(
                IncidentMember.unit_id == unit_id,
                IncidentMember.until_ns.is_(None),
                IncidentMember.from_ns < t_ns,
            )
            .values(until_ns=t_ns)
        )
        if incident_id:
            _add(
                session, IncidentMember, unit_id=unit_id, from_ns=t_ns, incident_id=incident_id,
                until_ns=None,
            )  # fmt: skip


_ASSIGNED_COLUMNS = ("unit_id", "person_id", "person_name", "crew", "role")
_START_COLUMNS = ("unit_id", "north_m", "east_m", "down_m", "heading_rad")


def _audit(session: Session, t_ns: int, done: OperatorAction) -> None:
    detail = msgspec.structs.asdict(done.action)
    match done.action:
        case SetPlan(geojson=geojson):
            detail = {"bytes": len(geojson), "incident_id": detail["incident_id"]}
        case Assign(person_id=person_id, person_name=""):
            detail["person_name"] = reference_to(person_id)
        case RemovePin(pin_id=pin_id):
            detail |= _whose_pin(session, pin_id)
    _add(
        session, AuditEntry, entry_id=done.action_id, t_ns=t_ns, by=done.by,
        action=type(done.action).__name__, detail=msgspec.json.encode(detail).decode(),
    )  # fmt: skip


def _whose_pin(session: Session, pin_id: str) -> dict[str, object]:
    """The units that a pin was about, from the audit of its setting; they may be forgotten."""
    group, _, of_group = pin_id.partition(":")
    if of_group:
        return {"unit_id": of_group}
    was_set = AuditEntry.action.in_([one.__name__ for one in (SetPin, StartTogether, SetMeeting)])
    of_this = AuditEntry.detail.contains(f'"pin_id":"{group}"', autoescape=True)
    newest = select(AuditEntry.detail).where(was_set, of_this).order_by(AuditEntry.number.desc())
    detail = session.scalars(newest.limit(1)).first()
    pin = {} if detail is None else msgspec.json.decode(detail)
    return {name: pin[name] for name in ("unit_id", "unit_ids", "other_unit_id") if name in pin}


def _alarm(session: Session, change: AlarmChange) -> None:
    t_ns, state = change.header.t_utc_ns, change.state.name.lower()
    described = {
        "text": change.text,
        "by": change.by,
        "code": change.code,
        # A map of a logged message has no order of its own.
        "parameters": msgspec.json.encode(change.parameters, order="deterministic").decode(),
        "reason": change.reason,
        "note": change.note,
        "peak": change.peak,
    }
    current = {
        "rule": change.rule,
        "unit_id": change.unit_id,
        "priority": change.priority,
        "state": state,
        "level": change.level,
        **described,
        "raised_ns": change.raised_ns,
        "last_raised_ns": change.last_raised_ns,
        "changed_ns": t_ns,
    }
    session.execute(
        insert_into(session, AlarmRow)
        .values(alarm_id=change.alarm_id, **current)
        .on_conflict_do_update(
            index_elements=[AlarmRow.alarm_id], set_=current, where=AlarmRow.changed_ns <= t_ns
        )
    )
    _add(
        session, AlarmTransition, alarm_id=change.alarm_id, t_ns=t_ns, state=state,
        level=change.level, **described,
    )  # fmt: skip


def _tracks(session: Session, tracks: Sequence[FusedPosition]) -> int:
    """Without what is no number, which no column takes; gives how many that were."""
    all_rows = [
        {
            "unit_id": fused.unit_id,
            "t_s": fused.t_meas_ns // NS_PER_S,
            "t_ns": fused.t_meas_ns,
            "north_m": fused.north_m,
            "east_m": fused.east_m,
            "down_m": fused.down_m,
            "std_north_m": fused.std_north_m,
            "std_east_m": fused.std_east_m,
            "std_down_m": fused.std_down_m,
            "heading_rad": fused.heading_rad,
            "floor": fused.floor,
            "quality": fused.quality.name.lower(),
        }
        for fused in tracks
    ]
    rows = [
        row
        for row in all_rows
        if not any(isinstance(value, float) and math.isnan(value) for value in row.values())
    ]
    if rows:
        if is_on_server(session):
            make_partitions(session, (fused.t_meas_ns // NS_PER_S for fused in tracks))
        _execute_many(session, insert_into(session, TrackPoint).on_conflict_do_nothing(), rows)
    return len(all_rows) - len(rows)


def _last_messages(session: Session, last_ns: Mapping[str, int]) -> None:
    rows = [
        {"unit_id": unit_id, **_NEW_UNIT, "last_heard_ns": t_ns}
        for unit_id, t_ns in last_ns.items()
    ]
    if rows:
        statement = insert_into(session, Unit)
        before_ns = func.coalesce(Unit.last_heard_ns, 0)
        latest = later_of(session, before_ns, statement.excluded.last_heard_ns)
        update_it = statement.on_conflict_do_update(
            index_elements=[Unit.unit_id], set_={"last_heard_ns": latest}
        )
        _execute_many(session, update_it, rows)


def _execute_many(session: Session, statement: Insert, rows: Sequence[Mapping[str, Any]]) -> None:
    """In the session's transaction, without making objects of the rows."""
    session.connection().execute(statement, rows)


def _described(description: UnitDescription) -> dict[str, object]:
    names = ("software_version", "source", "sensor_name", "tracker", "calibration", "has_gps")
    sensors = msgspec.json.encode(worn_sensors(description)).decode()
    return {name: getattr(description, name) for name in names} | {"sensors": sensors}


def _unit(session: Session, unit_id: str, **columns: object) -> None:
    session.execute(
        insert_into(session, Unit)
        .values(unit_id=unit_id, **(_NEW_UNIT | columns))
        .on_conflict_do_update(index_elements=[Unit.unit_id], set_=columns)
    )


def _end_assignments(session: Session, t_ns: int, which: ColumnElement[bool]) -> None:
    session.execute(
        update(Assignment)
        .where(which, Assignment.until_ns.is_(None), Assignment.from_ns < t_ns)
        .values(until_ns=t_ns)
    )


def _add(session: Session, table: type, **columns: object) -> None:
    """Insert unless it is there already."""
    session.execute(insert_into(session, table).values(**columns).on_conflict_do_nothing())
