"""Rows of a station's tables that belong to one incident, for a replay without that station."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import ColumnElement, and_, func, or_, select
from sqlalchemy.orm import Session

from base_station.storage.db.database import Database
from base_station.storage.db.models import (
    AlarmRow,
    AlarmTransition,
    AnchorRow,
    Assignment,
    Base,
    DispatchRow,
    ImportRow,
    IncidentMember,
    IncidentRow,
    Unit,
    UnitStart,
)
from base_station.storage.db.upserts import insert_into
from base_station.storage.db.window import FOREVER_NS

Row = dict[str, Any]

_TABLES: tuple[type[Base], ...] = (
    IncidentRow,
    IncidentMember,
    DispatchRow,
    ImportRow,
    Unit,
    Assignment,
    AlarmRow,
    AlarmTransition,
    AnchorRow,
    UnitStart,
)


def rows_of_incident(store: Database, incident: IncidentRow) -> dict[str, list[Row]]:
    """Return the rows by table: those of the incident's time, or all where rows have no time."""
    with store.read() as session:
        return {table.__tablename__: _rows(session, table, incident) for table in _TABLES}


def _rows(session: Session, table: type[Base], incident: IncidentRow) -> list[Row]:
    wanted = select(table.__table__).where(_is_of(table, incident))
    return [dict(row._mapping) for row in session.execute(wanted)]  # noqa: SLF001  # its documented name


def _is_of(table: type[Base], incident: IncidentRow) -> ColumnElement[bool]:
    opened_ns, closed_ns = incident.opened_ns, incident.closed_ns or FOREVER_NS
    raised = and_(AlarmRow.raised_ns >= opened_ns, AlarmRow.raised_ns < closed_ns)
    wearing = and_(
        Assignment.from_ns < closed_ns,
        func.coalesce(Assignment.until_ns, FOREVER_NS) > opened_ns,
    )
    of_incident: Mapping[type[Base], ColumnElement[bool]] = {
        IncidentRow: IncidentRow.incident_id == incident.incident_id,
        IncidentMember: IncidentMember.incident_id == incident.incident_id,
        ImportRow: ImportRow.incident_id == incident.incident_id,
        DispatchRow: DispatchRow.number == incident.dispatch_number,
        Unit: Unit.unit_id.in_(
            select(Assignment.unit_id)
            .where(wearing)
            .union(
                select(IncidentMember.unit_id).where(
                    IncidentMember.incident_id == incident.incident_id
                )
            )
        ),
        Assignment: wearing,
        AlarmRow: raised,
        AlarmTransition: AlarmTransition.alarm_id.in_(select(AlarmRow.alarm_id).where(raised)),
        AnchorRow: or_(AnchorRow.incident_id == "", AnchorRow.incident_id == incident.incident_id),
        UnitStart: and_(UnitStart.t_ns >= opened_ns, UnitStart.t_ns < closed_ns),
    }
    return of_incident[table]


def put_rows(store: Database, tables: Mapping[str, Sequence[Row]]) -> None:
    """Rows of another version may have columns that these tables lack: they are left out."""
    with store.write() as session:
        for table in _TABLES:
            columns = {column.key for column in table.__table__.columns}
            rows = [
                {name: value for name, value in row.items() if name in columns}
                for row in tables.get(table.__tablename__, ())
            ]
            if rows:
                session.execute(insert_into(session, table).on_conflict_do_nothing(), rows)
