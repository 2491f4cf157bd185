"""Tables of a department: writes and reads the reports of its stations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import msgspec
from sqlalchemy import func, select, tuple_
from sqlalchemy.orm import Session

from base_station.department_wire import (
    AlarmEvent,
    Event,
    EventBatch,
    EventBody,
    IncidentEvent,
    ParEvent,
    PersonEvent,
    kind_of,
    unpack_body,
)
from base_station.storage.db.database import Database
from base_station.storage.db.department_models import (
    SCHEMA_VERSION,
    DepartmentBase,
    DepartmentSchema,
    LastSummary,
    ReportedAlarm,
    ReportedAlarmCode,
    ReportedEvent,
    ReportedIncident,
    ReportedPerson,
    ReportedStream,
)
from base_station.storage.db.upserts import insert_into
from shared.errors import StoreError

_RESOLVED = "resolved"
_OPEN_FIRST = ReportedIncident.closed_ms.is_not(None), ReportedIncident.opened_ms.desc()


class Reported(NamedTuple):
    """Progress of the events of a station's outbox."""

    last_seq: int
    new: int  # of the batch, events that were not there
    people: tuple[PersonEvent, ...]  # people who were named, renamed or erased


class DepartmentTables:
    """Thread-safe; every method is one transaction.  Raises StoreError."""

    def __init__(self, store: Database) -> None:
        """Makes the tables where there are none."""
        self._store = store
        with store.write() as session:
            DepartmentBase.metadata.create_all(session.connection())
            version = session.scalar(select(DepartmentSchema.version))
            if version is None:
                session.add(DepartmentSchema(version=SCHEMA_VERSION))
            elif version != SCHEMA_VERSION:
                raise StoreError(
                    f"the department's tables in {store.name} have version {version}, which this "
                    "program does not know: a newer Muster made them. Update Muster, or use "
                    "another data folder"
                )

    def take(self, station: str, batch: EventBatch, offset_ms: int, received_ns: int) -> Reported:
        """Store the events of a batch that are new.  Raises WireError where one is damaged, and
        then stores none.
        """
        bodies = [unpack_body(event.body) for event in batch.events]
        new = 0
        people: list[PersonEvent] = []
        with self._store.write() as session:
            stream = session.get(ReportedStream, (station, batch.epoch))
            if stream is None:
                stream = ReportedStream(station=station, epoch=batch.epoch, last_seq=0, missing=0)
                session.add(stream)
            stream.last_seq = max(stream.last_seq, batch.dropped_seq)
            # It has receipts for events that are not here: this database was put back.
            stream.missing += max(batch.after_seq - stream.last_seq, 0)
            stream.last_seq = max(stream.last_seq, batch.after_seq)
            for event, body in zip(batch.events, bodies, strict=True):
                if event.seq <= stream.last_seq:
                    continue
                stream.missing += event.seq - stream.last_seq - 1
                stream.last_seq = event.seq
                if _insert_event(session, station, event, body, offset_ms, received_ns):
                    new += 1
                    people += [body] if isinstance(body, PersonEvent) else []
                    _apply(session, station, body, offset_ms)
            last_seq = stream.last_seq
        return Reported(last_seq, new, tuple(people))

    def keep_summaries(self, summaries: Sequence[LastSummary]) -> None:
        with self._store.write() as session:
            for one in summaries:
                session.merge(one)

    def last_summaries(self) -> Sequence[LastSummary]:
        with self._store.read() as session:
            return session.scalars(select(LastSummary)).all()

    def missing(self) -> dict[str, int]:
        """Numbers of events that never came, by station; those with none are left out."""
        total = func.sum(ReportedStream.missing)
        wanted = select(ReportedStream.station, total).group_by(ReportedStream.station)
        with self._store.read() as session:
            return {station: int(count) for station, count in session.execute(wanted) if count}

    def people(self) -> dict[tuple[str, str], ReportedPerson]:
        """By station and person id."""
        with self._store.read() as session:
            rows = session.scalars(select(ReportedPerson))
            return {(one.station, one.person_id): one for one in rows}

    def open_alarms(self, limit: int) -> tuple[Sequence[ReportedAlarm], int]:
        """The gravest and newest that are not resolved, and how many there are."""
        is_open = ReportedAlarm.state != _RESOLVED
        wanted = (
            select(ReportedAlarm)
            .where(is_open)
            .order_by(ReportedAlarm.priority, ReportedAlarm.raised_ms.desc())
            .limit(limit)
        )
        with self._store.read() as session:
            count = session.scalar(select(func.count()).select_from(ReportedAlarm).where(is_open))
            return session.scalars(wanted).all(), count or 0

    def incidents(self, limit: int) -> Sequence[ReportedIncident]:
        """Open ones first, then the newest."""
        wanted = select(ReportedIncident).order_by(*_OPEN_FIRST).limit(limit)
        with self._store.read() as session:
            return session.scalars(wanted).all()

    def find_incidents(
        self, search: str, skip: int, limit: int
    ) -> tuple[Sequence[ReportedIncident], int]:
        """A part of those with all words of ``search`` in their name or station, open ones first,
        then the newest; and how many there are.

        The words are compared here: SQLite folds the case of ASCII alone.
        """
        words = search.casefold().split()
        key = ReportedIncident.station, ReportedIncident.incident_id
        with self._store.read() as session:
            found = [
                (station, incident_id)
                for station, incident_id, name in session.execute(
                    select(*key, ReportedIncident.name).order_by(*_OPEN_FIRST)
                )
                if all(word in f"{name} {station}".casefold() for word in words)
            ]
            part = tuple_(*key).in_(found[skip : skip + limit])
            rows = session.scalars(select(ReportedIncident).where(part).order_by(*_OPEN_FIRST))
            return rows.all(), len(found)

    def incident(self, station: str, incident_id: str) -> ReportedIncident | None:
        with self._store.read() as session:
            return session.get(ReportedIncident, (station, incident_id))

    def events(self, before: int | None, limit: int) -> Sequence[ReportedEvent]:
        """In the order of arrival, the newest first; ``before``: a number, exclusive."""
        wanted = select(ReportedEvent).order_by(ReportedEvent.number.desc()).limit(limit)
        if before is not None:
            wanted = wanted.where(ReportedEvent.number < before)
        with self._store.read() as session:
            return session.scalars(wanted).all()


def _insert_event(
    session: Session,
    station: str,
    event: Event,
    body: EventBody | None,
    offset_ms: int,
    received_ns: int,
) -> bool:
    """False where it is there already."""
    has_name = isinstance(body, IncidentEvent | PersonEvent)
    row = {
        "station": station,
        "event_id": event.event_id,
        "kind": kind_of(body),
        "t_ms": event.t_ms,
        "offset_ms": offset_ms,
        "received_ns": received_ns,
        "body": b"" if has_name else bytes(event.body),
    }
    insert = insert_into(session, ReportedEvent).values(row).on_conflict_do_nothing()
    # A server's ``rowcount`` does not show whether there was a conflict.
    return session.scalar(insert.returning(ReportedEvent.number)) is not None


def _apply(session: Session, station: str, body: EventBody | None, offset_ms: int) -> None:
    match body:
        case AlarmEvent():
            _apply_alarm(session, station, body, offset_ms)
        case IncidentEvent():
            _apply_incident(session, station, body, offset_ms)
        case PersonEvent(person_id, name, crew, role):
            session.merge(
                ReportedPerson(
                    station=station, person_id=person_id, name=name, crew=crew, role=role
                )
            )
        case ParEvent() | None:
            pass  # the event itself is the record


def _apply_alarm(session: Session, station: str, alarm: AlarmEvent, offset_ms: int) -> None:
    """A transition that comes late, from the other machine of a station, changes nothing."""
    current = {**msgspec.structs.asdict(alarm), "offset_ms": offset_ms}
    parameters = msgspec.json.encode(current.pop("parameters")).decode()
    code = {"code": current.pop("code"), "parameters": parameters}
    coded = {"alarm_id": alarm.alarm_id, "changed_ms": alarm.changed_ms, **code}
    for table, values in ((ReportedAlarm, current), (ReportedAlarmCode, coded)):
        session.execute(
            insert_into(session, table)
            .values(station=station, **values)
            .on_conflict_do_update(
                index_elements=[table.station, table.alarm_id],
                set_=values,
                where=table.changed_ms <= alarm.changed_ms,
            )
        )


def _apply_incident(
    session: Session, station: str, incident: IncidentEvent, offset_ms: int
) -> None:
    """Apply an incident; a closed one stays closed."""
    found = session.get(ReportedIncident, (station, incident.incident_id))
    closed_ms = incident.closed_ms if found is None else found.closed_ms or incident.closed_ms
    session.merge(
        ReportedIncident(
            station=station,
            incident_id=incident.incident_id,
            name=incident.name,
            opened_ms=incident.opened_ms,
            closed_ms=closed_ms,
            offset_ms=offset_ms,
        )
    )
