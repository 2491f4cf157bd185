"""Wearers of the units in an incident, by time."""

from __future__ import annotations

from base_station.storage.db.members import Members
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import FOREVER_NS


def wearers(roster: Roster, incident: IncidentRow, members: Members) -> dict[str, list[str]]:
    """Names by unit, each once, in the order of wearing it."""
    names: dict[str, list[str]] = {}
    until_ns = incident.closed_ns or FOREVER_NS
    for one in roster.assignments(incident.opened_ns, until_ns):
        if not members.of(one.unit_id):
            continue
        worn = names.setdefault(one.unit_id, [])
        name = roster.wearer(one).name
        if name not in worn:
            worn.append(name)
    return names
