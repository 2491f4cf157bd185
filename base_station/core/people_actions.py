"""Operator actions about people: dispatches, incidents, wearers, accountability and rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import assert_never

import msgspec

from base_station.core import accountability, dispatches
from base_station.core.closed_incidents import add_closed_incident
from base_station.core.state import Person, StationState, UnitState
from base_station.core.state.trust_tally import TrustTally
from base_station.core.units import thermal_dose
from shared.errors import UserError
from shared.messages.station import (
    Assign,
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
    | Assign
    | Unassign
    | CheckIn
    | SetAccountability
    | SetRest
)


def apply_people_action(state: StationState, by: str, action: PeopleAction) -> Iterable[UnitState]:
    """Apply an action about who is there and accounted for."""
    changed: Iterable[UnitState]
    match action:
        case OpenIncident():
            changed = _open(state, action)
        case CloseIncident():
            changed = _close(state, action)
        case NoteDispatch():
            dispatches.note(state, action)
            changed = []
        case DismissDispatch():
            dispatches.dismiss(state, action.number)
            changed = []
        case Assign():
            changed = _assign(state, action)
        case Unassign():
            changed = [_unassign(state, state.registered_unit(action.unit_id))]
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


def _open(state: StationState, action: OpenIncident) -> Iterable[UnitState]:
    running = state.incident
    if running is not None and running.closed_ns is None:
        raise UserError(f"the incident {running.name!r} is open; close it first")
    number = action.dispatch_number
    report = dispatches.take(state, number) if number else None
    state.incident = accountability.new_incident(state, action, report)
    for unit in state.units.values():
        _restart(unit)
        accountability.begin(state, unit)
    return state.units.values()


def _restart(unit: UnitState) -> None:
    """Forget what counts from the opening of an incident on."""
    unit.trails.shown.clear()
    unit.trust = TrustTally()
    unit.place.inside_since_ns = None
    unit.heat.dose = unit.heat.late_dose = 0.0
    thermal_dose.restart_intervals(unit.heat.exposures)
    unit.rejected_counts.clear()


def _close(state: StationState, action: CloseIncident) -> Iterable[UnitState]:
    running = state.incident
    if (
        running is None
        or running.incident_id != action.incident_id
        or running.closed_ns is not None
    ):
        raise UserError(f"no open incident {action.incident_id}")
    state.incident = msgspec.structs.replace(running, closed_ns=state.t_ns)
    add_closed_incident(state, state.incident)
    for unit in state.units.values():
        accountability.end(state, unit)
    return state.units.values()


def _assign(state: StationState, action: Assign) -> Iterator[UnitState]:
    unit = state.registered_unit(action.unit_id)
    wearer, duty = unit.wearer, None
    for other in state.units.values():
        if other is not unit and other.wearer.person_id == action.person_id:
            duty = other.duty
            yield _unassign(state, other)
    same = wearer.person_id == action.person_id
    if wearer.person is not None and not same:
        unit.end_wearing(state.t_ns)
    wearer.person = Person(action.person_id, action.person_name, action.crew, action.role)
    if not same:
        wearer.since_ns = state.t_ns
        if duty is None:
            accountability.begin(state, unit)
        else:  # with another unit, which is no word of theirs, and no rest
            unit.duty = duty
    yield unit


def _unassign(state: StationState, unit: UnitState) -> UnitState:
    unit.end_wearing(state.t_ns)
    accountability.end(state, unit)
    return unit
