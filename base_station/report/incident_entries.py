"""Entries of the audit that belong to one incident, if several were open at the same time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from base_station.core.state import ERASED_TEXT
from base_station.report.orders import details_of
from base_station.storage.db.erasure import erased_detail
from base_station.storage.db.members import Members
from base_station.storage.db.models import Assignment, AuditEntry
from shared.messages.station import AssignIncident


def entries_of_incident(
    entries: Iterable[AuditEntry],
    incident_id: str,
    members: Members,
    assignments: Sequence[Assignment],
) -> list[AuditEntry]:
    """Entries that name the incident or its members, or that concern the whole station;
    ``assignments``: who wore which unit at that time.
    """
    if members.windows is None:
        return list(entries)
    return [one for one in entries if _is_of(one, incident_id, members, assignments)]


def _is_of(
    entry: AuditEntry, incident_id: str, members: Members, assignments: Sequence[Assignment]
) -> bool:
    if entry.detail.startswith(ERASED_TEXT):
        return entry.detail in (erased_detail(""), erased_detail(incident_id))
    details = details_of(entry)
    is_coming_or_leaving = entry.action == AssignIncident.__name__
    named = details.get("incident_id")
    if named and not is_coming_or_leaving:
        return bool(named == incident_id)
    units = _units_of(details, entry.t_ns, assignments)
    return not units or any(members.has(unit_id, entry.t_ns) for unit_id in units)


def _units_of(details: Mapping[str, Any], t_ns: int, assignments: Sequence[Assignment]) -> set[str]:
    """Units that an action concerns; empty if it concerns none."""
    units = {*details.get("unit_ids", ()), details.get("unit_id"), details.get("other_unit_id")}
    people = set(details.get("person_ids", ()))
    units |= {one.unit_id for one in assignments if one.person_id in people and _held(one, t_ns)}
    return units - {None, ""}


def _held(one: Assignment, t_ns: int) -> bool:
    return one.from_ns <= t_ns and (one.until_ns is None or t_ns <= one.until_ns)
