"""Members of incidents: which unit was in which one, from when until when."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec
from sqlalchemy import ColumnElement, and_, exists, or_, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.storage.db.models import IncidentMember, IncidentRow
from base_station.storage.db.window import FOREVER_NS, Window


class Members(msgspec.Struct, frozen=True):
    """Units of one incident, with the times at which they were in it."""

    window: Window  # of the incident
    windows: Mapping[str, Sequence[Window]] | None  # by unit; None: everybody, all the time

    def of(self, unit_id: str) -> Sequence[Window]:
        """Times at which a unit was in the incident, oldest first."""
        if self.windows is None:
            return [self.window]
        return self.windows.get(unit_id, ())

    def has(self, unit_id: str, t_ns: int) -> bool:
        """True where a unit was in the incident then, or its coming or leaving is of then."""
        return any(one.from_ns <= t_ns <= one.until_ns for one in self.of(unit_id))


def members_of(session: Session, incident: IncidentRow) -> Members:
    window = Window(incident.opened_ns, incident.closed_ns or FOREVER_NS)
    if not incident.has_members:
        return Members(window, None)
    rows = session.scalars(
        select(IncidentMember)
        .where(IncidentMember.incident_id == incident.incident_id)
        .order_by(IncidentMember.unit_id, IncidentMember.from_ns)
    )
    windows: dict[str, list[Window]] = {}
    for row in rows:
        during = Window(row.from_ns, row.until_ns or FOREVER_NS).within(window)
        windows.setdefault(row.unit_id, []).append(during)
    return Members(window, windows)


def was_member(
    incident: IncidentRow, unit_id: InstrumentedAttribute[str], t_ns: InstrumentedAttribute[int]
) -> ColumnElement[bool]:
    """Rows of units that were in the incident then, and of no unit."""
    member = exists().where(
        and_(
            IncidentMember.incident_id == incident.incident_id,
            IncidentMember.unit_id == unit_id,
            IncidentMember.from_ns <= t_ns,
            or_(IncidentMember.until_ns.is_(None), IncidentMember.until_ns >= t_ns),
        )
    )
    return or_(unit_id == "", member)
