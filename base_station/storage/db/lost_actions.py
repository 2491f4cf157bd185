"""Operators' actions that the log has lost, read from the audit, and the people of an incident,
read from the tables.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

import msgspec
from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from base_station.core.erasure.erasure import Record, Wearing
from base_station.core.people_actions import PeopleAction
from base_station.core.person_references import reference_to
from base_station.core.state import ERASED_TEXT
from base_station.storage.db.models import Assignment, AuditEntry, IncidentMember, IncidentRow
from shared.channels import OPERATOR
from shared.codec import encode
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import Assign, RegisterUnit

_KINDS = {one.__name__: one for one in (*PeopleAction.__args__, RegisterUnit)}


def lost_actions(session: Session, in_log: Collection[str]) -> Iterator[Record]:
    """Records of the actions about units, people and incidents whose ids are not ``in_log``, in
    their order.  Those of which an erasure has left nothing are not there.
    """
    wanted = select(AuditEntry).where(AuditEntry.action.in_(_KINDS)).order_by(AuditEntry.number)
    for entry in session.scalars(wanted):
        if entry.entry_id in in_log:
            continue
        try:
            action = msgspec.json.decode(entry.detail, type=_KINDS[entry.action])
        except msgspec.DecodeError:
            continue
        if isinstance(action, Assign):
            if action.person_id == ERASED_TEXT:
                continue
            if action.person_name == reference_to(action.person_id):  # for readers of the audit
                action = msgspec.structs.replace(action, person_name="")
        header = Header(STATION_ID, 0, 0, 0)
        done = OperatorAction(header, entry.entry_id, entry.by, action)
        yield entry.t_ns, OPERATOR.key(STATION_ID), encode(done)


def worn_in(session: Session, incident_id: str) -> list[Wearing]:
    """Return the times in which worn units were in the incident."""
    ended_ns = func.coalesce(IncidentMember.until_ns, IncidentRow.closed_ns)
    worn = (
        select(IncidentMember.unit_id, IncidentMember.from_ns, ended_ns)
        .join(IncidentRow, IncidentRow.incident_id == IncidentMember.incident_id)
        .join(Assignment, Assignment.unit_id == IncidentMember.unit_id)
        .where(
            IncidentMember.incident_id == incident_id,
            Assignment.from_ns < ended_ns,
            or_(Assignment.until_ns.is_(None), Assignment.until_ns > IncidentMember.from_ns),
        )
        .distinct()
    )
    return [Wearing(*row) for row in session.execute(worn)]
