"""Membership: the one incident in which the wearer of a unit works, of all that are open."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from base_station.core import accountability
from base_station.core.state import Incident, StationState, UnitState
from base_station.core.state.duty import Duty
from base_station.core.state.trust_tally import TrustTally
from base_station.core.units import thermal_dose
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages.station import AssignIncident


def open_memberships(state: StationState) -> dict[str, str]:
    """Ids of the open incidents of registered units, by unit; without those that are in none."""
    opened = ((unit, state.open_incident_of(unit)) for unit in state.units.values())
    return {
        unit.unit_id: incident.incident_id
        for unit, incident in opened
        if incident is not None and unit.registered
    }


def assign(state: StationState, action: AssignIncident) -> Iterator[UnitState]:
    """Assign units, with their wearers, to an open incident, or take them out of theirs.  UserError
    where a unit or the incident is unknown, before anything is changed.
    """
    if not action.unit_ids:
        raise UserError(coded("members-none-named", "no unit to assign: name at least one unit"))
    units = [state.registered_unit(one) for one in dict.fromkeys(action.unit_ids)]
    incident = state.named_incident(action.incident_id) if action.incident_id else None
    for unit in units:
        if incident is None:
            leave(state, unit)
        elif unit.incident_id != incident.incident_id:
            move(state, unit, incident)
        yield unit


def enter(state: StationState, units: Iterable[UnitState], incident: Incident) -> None:
    """Put units into an incident that was just opened: all counts restart."""
    for unit in units:
        unit.incident_id = incident.incident_id
        _reset_assignment_values(unit)
        unit.heat.dose = unit.heat.late_dose = 0.0
        thermal_dose.restart_intervals(unit.heat.exposures)
        accountability.begin(state, unit)


def move(state: StationState, unit: UnitState, incident: Incident) -> None:
    """Move a unit from another incident, or from none.  Its wearer's PAR is not confirmed there
    yet; heat, work and rest belong to the person and continue.
    """
    before = unit.duty
    accountability.end(state, unit)
    unit.incident_id = incident.incident_id
    _reset_assignment_values(unit)
    accountability.begin(state, unit)
    if before is not None and unit.duty is not None:
        accountability.continue_duty(state, unit, unit.duty, before)


def leave(state: StationState, unit: UnitState) -> None:
    """Take a unit out of its incident: it is unassigned."""
    accountability.end(state, unit)
    unit.incident_id = ""


def follow_person(
    state: StationState, unit: UnitState, came_from: Incident | None, duty: Duty | None
) -> None:
    """Move the unit that a person has put on into the person's incident.  A person without an
    incident stays in the unit's, or joins the only open one.  ``duty``: of the person, with another
    unit.
    """
    opened = state.open_incidents
    only = opened[0] if len(opened) == 1 else None
    incident = came_from or state.open_incident_of(unit) or only
    if incident is not None and unit.incident_id != incident.incident_id:
        move(state, unit, incident)
    if duty is None:
        accountability.begin(state, unit)
    else:  # with another unit, which is neither a PAR answer nor a rest
        unit.duty = duty


def _reset_assignment_values(unit: UnitState) -> None:
    """Reset the values that count from the assignment to an incident on."""
    unit.trails.shown.clear()
    unit.trust = TrustTally()
    unit.place.inside_since_ns = None
    unit.rejected_counts.clear()
