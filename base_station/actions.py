"""What becomes of a person's action: the live state follows it, or a reason why it does not."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import assert_never

from base_station import command_book
from base_station.alarms.book import AlarmBook
from base_station.command_state import SentCommand
from base_station.fusion.port import Start
from base_station.live_state import Alarm, Incident, Person, StationState, UnitState
from base_station.plan import read_plan
from base_station.positioning import Positioning
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.station import (
    AcknowledgeAlarm,
    Action,
    Assign,
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    RegisterUnit,
    ReportProblem,
    ResolveAlarm,
    SendCommand,
    SetAnchor,
    SetPlan,
    SetStart,
    Unassign,
)

Effect = Alarm | UnitState | SentCommand  # what an action changed


class Actions:
    """Applies operators' actions to the live state."""

    def __init__(self, book: AlarmBook, positioning: Positioning) -> None:
        self._book = book
        self._positioning = positioning

    def apply(self, state: StationState, by: str, action: Action) -> list[Effect]:
        """What changed; UserError where the action can have no effect."""
        return list(self._effects(state, by, action))

    def _effects(self, state: StationState, by: str, action: Action) -> Iterable[Effect]:
        effects: Iterable[Effect] = state.units.values()
        match action:
            case AcknowledgeAlarm() | ResolveAlarm():
                effects = [self._alarm(state, by, action)]
            case ReportProblem():
                effects = self._book.problem(state, action.part, action.text)
            case RegisterUnit():
                effects = self._register(state, action)
            case SetStart():
                effects = self._start(state, action)
            case SetAnchor():
                self._positioning.set_anchor(state, _anchor(action))
            case SetPlan():
                state.plan = read_plan(action.geojson)
            case OpenIncident():
                _open(state, action)
            case CloseIncident():
                _close(state, action)
            case Assign():
                effects = _assign(state, action)
            case Unassign():
                unit = _registered(state, action.unit_id)
                unit.person = None
                effects = [unit]
            case SendCommand() | ConfirmCommand():
                effects = [_command(state, by, action)]
            case _:
                assert_never(action)
        return effects

    def _alarm(
        self, state: StationState, by: str, action: AcknowledgeAlarm | ResolveAlarm
    ) -> Alarm:
        if isinstance(action, AcknowledgeAlarm):
            return _or_refuse(self._book.acknowledge(state, action.alarm_id, by))
        return _or_refuse(self._book.resolve(state, action.alarm_id, by, action.note))

    def _register(self, state: StationState, action: RegisterUnit) -> Iterator[Effect]:
        unit = state.units.get(action.unit_id)
        if unit is None:
            unit = state.units[action.unit_id] = UnitState(action.unit_id)
        unit.registered, unit.label = True, action.label
        yield unit
        yield from self._book.review(state, unit)

    def _start(self, state: StationState, action: SetStart) -> Iterator[Effect]:
        unit = _registered(state, action.unit_id)
        _require_finite(action.north_m, action.east_m, action.down_m, action.heading_rad)
        _require_finite(action.std_m, action.heading_std_rad)
        if action.std_m < 0.0 or action.heading_std_rad < 0.0:
            raise UserError("a start needs uncertainties that are not negative")
        start = Start(
            action.north_m,
            action.east_m,
            action.down_m,
            action.heading_rad,
            action.std_m,
            action.heading_std_rad,
        )
        self._positioning.start(state, unit, start)
        yield unit


def _command(state: StationState, by: str, action: SendCommand | ConfirmCommand) -> SentCommand:
    if isinstance(action, SendCommand):
        return command_book.send(state, by, action)
    return command_book.confirm(state, by, action)


def _open(state: StationState, action: OpenIncident) -> None:
    running = state.incident
    if running is not None and running.closed_ns is None:
        raise UserError(f"the incident {running.name!r} is open; close it first")
    state.incident = Incident(action.incident_id, action.name, state.t_ns)
    for unit in state.units.values():
        unit.trail.clear()
        unit.inside_since_ns = None


def _close(state: StationState, action: CloseIncident) -> None:
    running = state.incident
    if (
        running is None
        or running.incident_id != action.incident_id
        or running.closed_ns is not None
    ):
        raise UserError(f"no open incident {action.incident_id}")
    state.incident = Incident(running.incident_id, running.name, running.opened_ns, state.t_ns)


def _assign(state: StationState, action: Assign) -> Iterator[Effect]:
    unit = _registered(state, action.unit_id)
    for other in state.units.values():
        if other is not unit and other.person and other.person.person_id == action.person_id:
            other.person = None
            yield other
    unit.person = Person(action.person_id, action.person_name, action.crew, action.role)
    yield unit


def _anchor(action: SetAnchor) -> Anchor:
    _require_finite(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)
    if abs(action.lat_deg) > 90.0 or abs(action.lon_deg) > 180.0:
        raise UserError(f"{action.lat_deg}, {action.lon_deg} is no latitude and longitude")
    return Anchor(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)


def _or_refuse(outcome: Alarm | str) -> Alarm:
    if isinstance(outcome, str):
        raise UserError(outcome)
    return outcome


def _registered(state: StationState, unit_id: str) -> UnitState:
    unit = state.units.get(unit_id)
    if unit is None or not unit.registered:
        raise UserError(f"no registered unit {unit_id!r}; register it first")
    return unit


def _require_finite(*values: float) -> None:
    if not all(math.isfinite(value) for value in values):
        raise UserError("a coordinate or angle is no finite number")
