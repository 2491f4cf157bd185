"""Operator actions about people: dispatches, incidents, wearers, accountability and rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import assert_never

import msgspec

from base_station.core import accountability, dispatches, incident_membership
from base_station.core.closed_incidents import add_closed_incident
from base_station.core.state import OWN_SITE_ID, Person, SiteState, StationState, UnitState
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages.station import (
    Assign,
    AssignIncident,
    CheckIn,
    CloseIncident,
    DismissDispatch,
    NoteDispatch,
    OpenIncident,
    SetAccountability,
    SetRest,
    Unassign,
)

PeopleAction = (
    OpenIncident
    | CloseIncident
    | NoteDispatch
    | DismissDispatch
    | AssignIncident
    | Assign
    | Unassign
    | CheckIn
    | SetAccountability
    | SetRest
)


def apply_people_action(state: StationState, by: str, action: PeopleAction) -> Iterable[UnitState]:
    """Apply an action about people and their accountability."""
    changed: Iterable[UnitState]
    match action:
        case OpenIncident():
            changed = _open_incident(state, action)
        case CloseIncident():
            changed = _close_incident(state, action)
        case NoteDispatch():
            dispatches.note(state, action)
            changed = []
        case DismissDispatch():
            dispatches.dismiss(state, action.number)
            changed = []
        case AssignIncident():
            changed = incident_membership.assign(state, action)
        case Assign():
            changed = _assign_unit(state, action)
        case Unassign():
            changed = [_unassign_unit(state, state.registered_unit(action.unit_id))]
        case CheckIn():
            changed = accountability.check_in(state, by, action)
        case SetAccountability():
            changed = accountability.change_intervals(state, action)
        case SetRest():
            unit = state.registered_unit(action.unit_id)
            accountability.set_rest(state, unit, action.resting)
            changed = [unit]
        case _:
            assert_never(action)
    return changed


def _open_incident(state: StationState, action: OpenIncident) -> Iterable[UnitState]:
    """Open an incident: all units are in it, unless others are open."""
    opened = state.open_incidents
    if opened and not action.beside_others:
        raise UserError(
            coded(
                "incident-still-open",
                "the incident {incident!r} is open; close it first",
                incident=opened[-1].name,
            )
        )
    if action.incident_id in state.incidents:
        raise UserError(
            coded(
                "incident-id-taken",
                "an incident needs an id of its own, not {incident!r}",
                incident=action.incident_id,
            )
        )
    is_used = any(one.site_id == OWN_SITE_ID for one in opened)
    site_id = action.incident_id if is_used else OWN_SITE_ID
    number = action.dispatch_number
    report = dispatches.take(state, number) if number else None
    incident = accountability.new_incident(state, action, site_id, report)
    left = _end_before(state, site_id, is_only=not opened)
    state.incidents[incident.incident_id] = incident
    state.sites.setdefault(site_id, SiteState())
    if opened:
        return left
    units = list(state.units.values())
    incident_membership.enter(state, units, incident)
    return units


def _end_before(state: StationState, site_id: str, *, is_only: bool) -> list[UnitState]:
    """Drop the closed incidents of this site, or of all; returns the units that were in them."""
    incidents = state.incidents.values()
    closed = [one for one in incidents if one.closed_ns is not None]
    over = {one.incident_id for one in closed if is_only or one.site_id == site_id}
    for incident_id in over:
        del state.incidents[incident_id]
    left = [unit for unit in state.units.values() if unit.incident_id in over]
    for unit in left:
        incident_membership.leave(state, unit)
    return left


def _close_incident(state: StationState, action: CloseIncident) -> Iterable[UnitState]:
    if not action.incident_id:
        raise UserError(coded("incident-without-id", "no open incident without an id"))
    running = state.named_incident(action.incident_id)
    closed = msgspec.structs.replace(running, closed_ns=state.t_ns)
    state.incidents[closed.incident_id] = closed
    add_closed_incident(state, closed)
    members = [unit for unit in state.units.values() if unit.incident_id == closed.incident_id]
    for unit in members:
        accountability.end(state, unit)
    return members


def _assign_unit(state: StationState, action: Assign) -> Iterator[UnitState]:
    unit = state.registered_unit(action.unit_id)
    wearer, duty, came_from = unit.wearer, None, None
    for other in state.units.values():
        if other is not unit and other.wearer.person_id == action.person_id:
            duty, came_from = other.duty, state.open_incident_of(other)
            yield _unassign_unit(state, other)
    same = wearer.person_id == action.person_id
    if wearer.person is not None and not same:
        unit.end_wearing(state.t_ns)
    wearer.person = Person(action.person_id, action.person_name, action.crew, action.role)
    if not same:
        wearer.since_ns = state.t_ns
        if action.keeps_incident:
            accountability.begin(state, unit)
        else:
            incident_membership.follow_person(state, unit, came_from, duty)
    yield unit


def _unassign_unit(state: StationState, unit: UnitState) -> UnitState:
    unit.end_wearing(state.t_ns)
    accountability.end(state, unit)
    return unit
