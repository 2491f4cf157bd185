"""Who is accounted for: the roll call (PAR), and how long people have been at work.

While an incident is open, everybody who wears a unit is to be heard from again and again.  Only a
person counts: the wearer's own button, or somebody at the console who has heard the wearer.
Nothing that a unit measures completes a roll call.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import msgspec

from base_station.commands.state import SentCommand
from base_station.live_state import (
    Duty,
    Incident,
    StationState,
    UnitState,
)
from base_station.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.messages import CommandKind
from shared.messages.station import CheckIn, OpenIncident, SetAccountability

ANSWER_NS = 180 * NS_PER_S  # for a roll call that somebody asks for, or an evacuation (ours)
SHORTEST_S, LONGEST_S = 30.0, 12 * 3600.0
CALLS = frozenset({CommandKind.PAR_REQUEST, CommandKind.EVACUATE})  # who was told is to answer


def new_incident(state: StationState, action: OpenIncident) -> Incident:
    """With the usual times where none are given."""
    par_s = action.par_interval_s or PAR_INTERVAL_S
    work_s = action.work_limit_s or WORK_LIMIT_S
    _check(par_s, work_s)
    return Incident(action.incident_id, action.name, state.t_ns, None, par_s, work_s)


def change_times(state: StationState, action: SetAccountability) -> Iterator[UnitState]:
    """Other times for the open incident, from now on and for everybody."""
    incident = _open_incident(state)
    _check(action.par_interval_s, action.work_limit_s)
    state.incident = msgspec.structs.replace(
        incident, par_interval_s=action.par_interval_s, work_limit_s=action.work_limit_s
    )
    for unit in state.units.values():
        if unit.duty is not None:
            _note_due(state, unit.duty)
            yield unit


def begin(state: StationState, unit: UnitState, by: str) -> None:
    """Who wears this unit is on duty from now on, where an incident is open."""
    incident = state.incident
    if incident is not None and incident.closed_ns is None and unit.person is not None:
        unit.duty = Duty(state.t_ns, by, ready_ns=state.t_ns)
        _note_due(state, unit.duty)


def end(state: StationState, unit: UnitState) -> None:
    """Nobody waits for this unit's wearer any more."""
    if unit.duty is not None:
        unit.duty, unit.off_duty_ns = None, state.t_ns


def check_in(state: StationState, by: str, action: CheckIn) -> list[UnitState]:
    """Somebody has heard from them.  UserError where nobody is on duty."""
    if sum(map(bool, (action.unit_id, action.crew, action.everyone))) != 1:
        raise UserError("say one of: a unit, a crew, everyone")
    found = [unit for unit in state.units.values() if _is_meant(unit, action)]
    if not found:
        whom = action.unit_id or action.crew or "everyone"
        raise UserError(f"nobody of {whom} is on duty in an open incident")
    for unit in found:
        vouch(state, unit, by, state.t_ns)
    return found


def vouch(state: StationState, unit: UnitState, by: str, t_ns: int) -> None:
    """A person says that the wearer of this unit was well at ``t_ns``."""
    duty = unit.duty
    if duty is None or t_ns <= duty.checked_in_ns:
        return
    duty.checked_in_ns, duty.checked_in_by = t_ns, by
    duty.asks_ns = [asked_ns for asked_ns in duty.asks_ns if asked_ns > t_ns]
    _note_due(state, duty)


def ask(state: StationState, command: SentCommand) -> Iterator[UnitState]:
    """After a roll call or an evacuation: who was told is to be heard from soon."""
    if command.kind not in CALLS:
        return
    for unit_id in command.deliveries:
        unit = state.units[unit_id]
        if unit.duty is not None:
            unit.duty.asks_ns.append(state.t_ns)
            _note_due(state, unit.duty)
            yield unit


def note_answer(
    state: StationState, unit: UnitState, command: SentCommand, by: str, answered_ns: int | None
) -> list[UnitState]:
    """A person answered a command, at some time since it was given, where nobody can tell when as
    long ago as that; who has heard of an evacuation is not out by that.
    """
    if command.kind is not CommandKind.PAR_REQUEST or unit.duty is None:
        return []
    vouch(state, unit, by, max(answered_ns or 0, command.issued_ns))
    return [unit]


def set_rest(state: StationState, unit: UnitState, resting: bool) -> None:
    """The wearer goes to rest, or is ready for work again.  UserError where that is so already."""
    duty = unit.duty
    if duty is None:
        raise UserError(f"{unit.name} is not on duty in an open incident")
    if resting == (duty.rest_since_ns is not None):
        raise UserError(f"{unit.name} is {'resting' if resting else 'at work'} already")
    duty.rest_since_ns = state.t_ns if resting else None
    duty.ready_ns = state.t_ns
    duty.work_since_ns = None
    _note_due(state, duty)


def note_work(state: StationState, unit: UnitState) -> bool:
    """At a tick: work begins when the wearer goes in, and lasts until the rest."""
    duty = unit.duty
    if duty is None or duty.rest_since_ns is not None or duty.work_since_ns is not None:
        return False
    if unit.inside_since_ns is None:
        return False
    duty.work_since_ns = max(unit.inside_since_ns, duty.ready_ns)
    _note_due(state, duty)
    return True


def warning_s(incident: Incident) -> float:
    """How long before it is due a check-in is announced."""
    return min(5 * 60.0, incident.par_interval_s / 4)


def _note_due(state: StationState, duty: Duty) -> None:
    """What the alarm rules look at: when the next check-in and the next rest are due."""
    incident = _open_incident(state)
    duty.due_ns = duty.checked_in_ns + round(incident.par_interval_s * NS_PER_S)
    if duty.asked_ns is not None:
        duty.due_ns = min(duty.due_ns, duty.asked_ns + ANSWER_NS)
    duty.rest_due_ns = None
    if duty.work_since_ns is not None:
        duty.rest_due_ns = duty.work_since_ns + round(incident.work_limit_s * NS_PER_S)


def _is_meant(unit: UnitState, action: CheckIn) -> bool:
    if unit.duty is None or unit.person is None:
        return False
    if action.unit_id:
        return action.unit_id == unit.unit_id
    return action.everyone or action.crew == unit.person.crew


def _open_incident(state: StationState) -> Incident:
    if state.incident is None or state.incident.closed_ns is not None:
        raise UserError("no incident is open")
    return state.incident


def _check(par_interval_s: float, work_limit_s: float) -> None:
    for what, time_s in (("roll call", par_interval_s), ("rest", work_limit_s)):
        if not (math.isfinite(time_s) and SHORTEST_S <= time_s <= LONGEST_S):
            raise UserError(
                f"the time until the next {what} is {SHORTEST_S:.0f} s to {LONGEST_S / 3600:.0f} h"
            )
