"""Accountability (PAR) and working time of members.

While an incident is open, each wearer of a unit must be confirmed at regular intervals: by the
button of the own unit, or by radio, which an operator enters at the console.  Assigning a unit or
opening an incident confirms no member, and neither does any measurement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import msgspec

from base_station.core.state import Incident, StationState, UnitState
from base_station.core.state.command import SentCommand
from base_station.core.state.duty import Duty, ParConfirmation, Source
from base_station.core.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from shared.clock import NS_PER_S
from shared.coded_text import Measure, Term, coded
from shared.errors import UserError
from shared.messages import CommandKind
from shared.messages.station import (
    CheckIn,
    NoteDispatch,
    OpenIncident,
    SetAccountability,
    UndoConfirmation,
)

ANSWER_NS = 180 * NS_PER_S  # to answer a PAR request or an evacuation (ours)
SHORTEST_S, LONGEST_S = 30.0, 12 * 3600.0
PAR_REQUESTS = frozenset({CommandKind.PAR_REQUEST, CommandKind.EVACUATE})  # to be answered


def new_incident(
    state: StationState, action: OpenIncident, site_id: str, dispatch: NoteDispatch | None
) -> Incident:
    """New incident on a site, with the usual intervals where none are given."""
    par_s = action.par_interval_s or PAR_INTERVAL_S
    work_s = action.work_limit_s or WORK_LIMIT_S
    _require_valid_times(par_s, work_s)
    opened = action.incident_id, action.name, state.t_ns
    return Incident(*opened, None, par_s, work_s, site_id, dispatch)


def change_intervals(state: StationState, action: SetAccountability) -> Iterator[UnitState]:
    """Set other intervals for an open incident, from now on and for all its members."""
    incident = state.named_incident(action.incident_id)
    _require_valid_times(action.par_interval_s, action.work_limit_s)
    state.incidents[incident.incident_id] = msgspec.structs.replace(
        incident, par_interval_s=action.par_interval_s, work_limit_s=action.work_limit_s
    )
    for unit in state.units.values():
        if unit.duty is not None and unit.incident_id == incident.incident_id:
            _update_due(state, unit, unit.duty)
            yield unit


def begin(state: StationState, unit: UnitState) -> None:
    """Put the wearer of this unit on duty, where the unit is in an open incident."""
    if state.open_incident_of(unit) is not None and unit.wearer.person is not None:
        unit.duty = Duty(state.t_ns, ready_ns=state.t_ns)
        _update_due(state, unit, unit.duty)


def end(state: StationState, unit: UnitState) -> None:
    """Take the wearer of this unit off duty."""
    if unit.duty is not None:
        unit.duty, unit.off_duty_ns = None, state.t_ns


def continue_duty(state: StationState, unit: UnitState, duty: Duty, before: Duty) -> None:
    """Carry work and rest of a duty over into the next one, which another incident has begun."""
    duty.ready_ns, duty.rest_since_ns = before.ready_ns, before.rest_since_ns
    duty.work_since_ns = before.work_since_ns
    _update_due(state, unit, duty)


def check_in(state: StationState, by: str, action: CheckIn) -> list[UnitState]:
    """Record PARs confirmed by radio.  UserError where no recipient is on duty."""
    if sum(map(bool, (action.unit_id, action.crew, action.person_ids, action.everyone))) != 1:
        raise UserError(
            coded(
                "check-in-addressee",
                "say one of: a unit, a crew or floor that has members, everyone",
            )
        )
    if action.check_in_id and _is_taken(state, action.check_in_id):
        raise UserError(
            coded(
                "check-in-id-taken",
                "a check-in needs an id of its own, not {check_in!r}",
                check_in=action.check_in_id,
            )
        )
    incident_id = action.incident_id
    if action.everyone and state.open_incidents:
        incident_id = state.named_incident(incident_id).incident_id
    found = [
        unit
        for unit in state.units.values()
        if incident_id in ("", unit.incident_id) and _is_addressed(unit, action)
    ]
    if not found:
        recipients = (
            action.unit_id or action.crew or ("the crew" if action.person_ids else "everyone")
        )
        raise UserError(
            coded(
                "check-in-nobody",
                "nobody of {recipients} is on duty in an open incident",
                recipients=recipients,
            )
        )
    for unit in found:
        _record_confirmation(
            state, unit, ParConfirmation(state.t_ns, "radio", by, action.check_in_id)
        )
    return found


def undo(state: StationState, action: UndoConfirmation) -> list[UnitState]:
    """Undo the radio confirmations with this id; returns the units concerned."""
    return [unit for unit in state.units.values() if _is_undone(state, unit, action)]


def ask(state: StationState, command: SentCommand) -> Iterator[UnitState]:
    """Make the PAR of each recipient due soon, after a PAR request or an evacuation."""
    if command.kind not in PAR_REQUESTS:
        return
    for unit_id in command.deliveries:
        unit = state.units[unit_id]
        if unit.duty is not None:
            unit.duty.requests_ns.append(state.t_ns)
            _update_due(state, unit, unit.duty)
            yield unit


def record_answer(
    state: StationState,
    unit: UnitState,
    command: SentCommand,
    source: Source,
    by: str,
    answered_ns: int | None,
) -> list[UnitState]:
    """Confirm the PAR of a wearer who answered a PAR request.  An answer of unknown time counts
    from the time of the request.  The answer to an evacuation confirms nothing: the wearer may
    still be inside.
    """
    if command.kind is not CommandKind.PAR_REQUEST or unit.duty is None:
        return []
    t_ns = max(answered_ns or 0, command.issued_ns)
    entry_id = command.command_id if source == "radio" else ""
    _record_confirmation(state, unit, ParConfirmation(t_ns, source, by, entry_id))
    return [unit]


def set_rest(state: StationState, unit: UnitState, resting: bool) -> None:
    """Send the wearer to rest, or back to work.  UserError where the wearer is there already."""
    duty = unit.duty
    if duty is None:
        raise UserError(
            coded("not-on-duty", "{name} is not on duty in an open incident", name=unit.name)
        )
    if resting == (duty.rest_since_ns is not None):
        raise UserError(_rest_unchanged(unit.name, resting))
    duty.rest_since_ns = state.t_ns if resting else None
    duty.ready_ns = state.t_ns
    duty.work_since_ns = None
    _update_due(state, unit, duty)


def _rest_unchanged(name: str, resting: bool) -> str:
    if resting:
        return coded("rests-already", "{name} is in rehab already", name=name)
    return coded("works-already", "{name} is at work already", name=name)


def update_work(state: StationState, unit: UnitState) -> bool:
    """At a tick, begin the working time of a wearer who is inside; it lasts until the rest."""
    duty = unit.duty
    if duty is None or duty.rest_since_ns is not None or duty.work_since_ns is not None:
        return False
    if unit.place.inside_since_ns is None:
        return False
    duty.work_since_ns = max(unit.place.inside_since_ns, duty.ready_ns)
    _update_due(state, unit, duty)
    return True


def warning_s(incident: Incident) -> float:
    """Time before a PAR is due at which it is announced."""
    return min(5 * 60.0, incident.par_interval_s / 4)


def _record_confirmation(
    state: StationState, unit: UnitState, confirmation: ParConfirmation
) -> None:
    """Record a confirmation; one from before this duty concerns another member or incident."""
    duty = unit.duty
    if duty is not None and confirmation.t_ns >= duty.since_ns:
        duty.confirm(confirmation)
        _update_due(state, unit, duty)


def _is_undone(state: StationState, unit: UnitState, action: UndoConfirmation) -> bool:
    duty = unit.duty
    if duty is None or action.unit_id not in ("", unit.unit_id):
        return False
    if not duty.undo(action.entry_id):
        return False
    _update_due(state, unit, duty)
    return True


def _is_taken(state: StationState, entry_id: str) -> bool:
    on_duty = (unit.duty for unit in state.units.values() if unit.duty is not None)
    entered = (one.entry_id for duty in on_duty for one in duty.confirmations)
    return entry_id in state.commands or entry_id in entered


def _update_due(state: StationState, unit: UnitState, duty: Duty) -> None:
    """Set when the next PAR and the next rest are due, for the alarm rules."""
    incident = state.open_incident_of(unit)
    assert incident is not None  # duty ends with it
    duty.due_ns = duty.counts_from_ns + round(incident.par_interval_s * NS_PER_S)
    if duty.open_request_ns is not None:
        duty.due_ns = min(duty.due_ns, duty.open_request_ns + ANSWER_NS)
    duty.rest_due_ns = None
    if duty.work_since_ns is not None:
        duty.rest_due_ns = duty.work_since_ns + round(incident.work_limit_s * NS_PER_S)


def _is_addressed(unit: UnitState, action: CheckIn) -> bool:
    if unit.duty is None or unit.wearer.person is None:
        return False
    if action.unit_id:
        return action.unit_id == unit.unit_id
    if action.person_ids:
        return unit.wearer.person.person_id in action.person_ids
    return action.everyone or action.crew == unit.wearer.person.crew


def _require_valid_times(par_interval_s: float, work_limit_s: float) -> None:
    par, rehab = Term("roll_call", "PAR"), Term("rest", "rehab")
    for what, time_s in ((par, par_interval_s), (rehab, work_limit_s)):
        if not (math.isfinite(time_s) and SHORTEST_S <= time_s <= LONGEST_S):
            raise UserError(
                coded(
                    "incident-time-unfit",
                    "the time until the next {what} is {shortest_s} to {longest_s}",
                    what=what,
                    shortest_s=Measure(SHORTEST_S, f"{SHORTEST_S:.0f} s"),
                    longest_s=Measure(LONGEST_S, f"{LONGEST_S / 3600:.0f} h"),
                )
            )
