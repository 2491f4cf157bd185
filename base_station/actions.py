"""What becomes of a person's action: the live state follows it, or a reason why it does not."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import assert_never

import msgspec

from base_station import accountability, once
from base_station.alarms.book import AlarmBook
from base_station.assessment.tally import TrustTally
from base_station.commands import book as command_book
from base_station.commands.state import SentCommand
from base_station.events import NamesForgotten, PastTouched, PinsTouched, TrailFilled
from base_station.fusion.fixes.sky import Sky
from base_station.fusion.port import Start
from base_station.live_state import Alarm, Person, StationState, UnitState
from base_station.past_incidents import note_closed
from base_station.pins import book as pin_book
from base_station.pins.book import PinAction, change_pins, units_of
from base_station.pins.debriefing import looks_back
from base_station.pins.late_history import note_late
from base_station.positioning.positioning import Positioning
from base_station.site.plan import read_plan
from base_station.units import heat_told
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.pins import PlaceBeacon, SetPin, StartTogether
from shared.messages.station import (
    AcknowledgeAlarm,
    Action,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    DoneApart,
    ForgetWearers,
    OpenIncident,
    RegisterUnit,
    ReportProblem,
    ResolveAlarm,
    SendCommand,
    SetAccountability,
    SetAnchor,
    SetPlan,
    SetReference,
    SetRest,
    SetStart,
    SetThresholds,
    TakeOver,
    Unassign,
)

# What an action changed.
Effect = Alarm | UnitState | SentCommand | PinsTouched | PastTouched | TrailFilled | NamesForgotten


class Actions:
    """Applies operators' actions to the live state."""

    def __init__(self, book: AlarmBook, positioning: Positioning) -> None:
        self._book = book
        self._positioning = positioning

    def apply(self, state: StationState, by: str, action: Action) -> list[Effect]:
        """What changed; UserError where the action can have no effect."""
        return list(self._effects(state, by, action))

    def _effects(self, state: StationState, by: str, action: Action) -> Iterable[Effect]:
        if isinstance(action, PinAction):
            return self._pin(state, by, action)
        effects: Iterable[Effect] = state.units.values()
        match action:
            case AcknowledgeAlarm() | ResolveAlarm():
                effects = [self._alarm(state, by, action)]
            case ReportProblem() | SetThresholds():
                effects = self._of_itself(state, action)
            case RegisterUnit():
                effects = self._register(state, action)
            case SetStart():
                effects = self._start(state, action)
            case SetAnchor() | SetPlan() | SetReference():
                self._site(state, action)
            case TakeOver():
                state.take_overs.append(action)
            case DoneApart():
                effects = ()  # people are told of it by a report of the station
            case SendCommand() | ConfirmCommand():
                effects = self._command(state, by, action)
            case ForgetWearers():
                effects = self._forget(state, action)
            case OpenIncident():
                effects = self._open(state, by, action)
            case _:
                effects = self._reviewed(state, _people(state, by, action))
        return effects

    def _site(self, state: StationState, action: SetAnchor | SetPlan | SetReference) -> None:
        if isinstance(action, SetAnchor):
            self._positioning.set_anchor(state, _anchor(action))
        elif isinstance(action, SetReference):
            _require_finite(action.down_m)
            unit_id = _registered(state, action.unit_id).unit_id if action.unit_id else None
            state.barometers.refer_to(unit_id, action.down_m)
            state.sky = Sky()
        else:
            state.plan = read_plan(action.geojson)
            self._positioning.consider(state.laid_plan)
            self._positioning.renumber(state)
            for unit_id in sorted(set().union(*map(units_of, state.pins.values()))):
                note_late(state.late, unit_id, state.t_ns)  # one by one: live goes first

    def _pin(self, state: StationState, by: str, action: PinAction) -> Iterator[Effect]:
        is_first = isinstance(action, SetPin | StartTogether | PlaceBeacon) and _is_first(state)
        running = state.incident
        closed_ns = None if running is None else running.closed_ns
        is_of_past = closed_ns is not None and looks_back(state, action, closed_ns)
        changed = change_pins(state, by, action)
        if is_of_past and running is not None:
            yield PastTouched(running.incident_id)
        if is_first:
            yield from map(TrailFilled, moved := sorted(self._positioning.lay_on_plan(state)))
            changed |= set(moved)
        yield _pins_of(changed)

    def _alarm(
        self, state: StationState, by: str, action: AcknowledgeAlarm | ResolveAlarm
    ) -> Alarm:
        if isinstance(action, AcknowledgeAlarm):
            return _or_refuse(self._book.acknowledge(state, by, action))
        return _or_refuse(self._book.resolve(state, by, action))

    def _of_itself(
        self, state: StationState, action: ReportProblem | SetThresholds
    ) -> Iterator[Effect]:
        """What the station says without being asked."""
        if isinstance(action, ReportProblem):
            yield from self._book.problem(state, action.part, action.text)
        else:
            state.thresholds = action.thresholds
            self._book.use(action.thresholds)
            yield from self._reviewed(state, state.units.values())

    def _register(self, state: StationState, action: RegisterUnit) -> Iterator[Effect]:
        unit = state.units.get(action.unit_id)
        if unit is None:
            unit = state.units[action.unit_id] = UnitState(action.unit_id)
        unit.registered, unit.label = True, action.label
        yield from self._reviewed(state, [unit])

    def _reviewed(self, state: StationState, units: Iterable[UnitState]) -> Iterator[Effect]:
        """What changed of units may raise or resolve alarms at once."""
        for unit in units:
            yield unit
            yield from self._book.review(state, unit)

    def _command(
        self, state: StationState, by: str, action: SendCommand | ConfirmCommand
    ) -> Iterator[Effect]:
        if isinstance(action, SendCommand):
            command = command_book.send(state, by, action)
            yield from command_book.replace(state, command)
            touched = list(accountability.ask(state, command))
        else:
            command = command_book.confirm(state, by, action)
            unit = state.units[action.unit_id]
            touched = accountability.note_answer(state, unit, command, by, state.t_ns)
        yield command
        yield from self._reviewed(state, touched)

    def _open(self, state: StationState, by: str, action: OpenIncident) -> Iterator[Effect]:
        before = state.incident
        units = list(_people(state, by, action))
        before_ns = 0 if before is None else before.closed_ns or 0
        yield _pins_of(self._positioning.begin_incident(state, before_ns))
        yield from self._reviewed(state, units)

    def _forget(self, state: StationState, action: ForgetWearers) -> list[Effect]:
        unit = _registered(state, action.unit_id)
        if state.incident is not None and state.incident.closed_ns is None:
            raise UserError("an incident is open; close it first")
        self._positioning.forget(state, unit)
        met = pin_book.forget(state, unit.unit_id)
        self._book.forget(state, unit)
        once.forget_words(state)
        unit.forget_wearers()
        told = command_book.forget(state, unit)
        return [unit, TrailFilled(unit.unit_id), *told, _pins_of(met), NamesForgotten()]

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
        touched = {unit.unit_id}
        if _is_first(state):
            touched |= self._positioning.lay_on_plan(state)
        self._positioning.start(state, unit, start)
        yield _pins_of(touched)
        yield from map(TrailFilled, sorted(touched))


PeopleAction = (
    OpenIncident | CloseIncident | Assign | Unassign | CheckIn | SetAccountability | SetRest
)


def _people(state: StationState, by: str, action: PeopleAction) -> Iterable[UnitState]:
    """Who is there, and who is accounted for."""
    changed: Iterable[UnitState]
    match action:
        case OpenIncident():
            changed = _open(state, by, action)
        case CloseIncident():
            changed = _close(state, action)
        case Assign():
            changed = _assign(state, by, action)
        case Unassign():
            changed = [_without_wearer(state, _registered(state, action.unit_id))]
        case CheckIn():
            changed = accountability.check_in(state, by, action)
        case SetAccountability():
            changed = accountability.change_times(state, action)
        case SetRest():
            unit = _registered(state, action.unit_id)
            accountability.set_rest(state, unit, action.resting)
            changed = [unit]
        case _:
            assert_never(action)
    return changed


def _open(state: StationState, by: str, action: OpenIncident) -> Iterable[UnitState]:
    running = state.incident
    if running is not None and running.closed_ns is None:
        raise UserError(f"the incident {running.name!r} is open; close it first")
    state.incident = accountability.new_incident(state, action)
    for unit in state.units.values():
        unit.trail.clear()
        unit.trust = TrustTally()
        unit.inside_since_ns = None
        unit.heat_dose = unit.late_heat_dose = 0.0
        heat_told.forget_all_but_last(unit.heat_told)
        unit.not_used.clear()
        accountability.begin(state, unit, by)
    return state.units.values()


def _close(state: StationState, action: CloseIncident) -> Iterable[UnitState]:
    running = state.incident
    if (
        running is None
        or running.incident_id != action.incident_id
        or running.closed_ns is not None
    ):
        raise UserError(f"no open incident {action.incident_id}")
    state.incident = msgspec.structs.replace(running, closed_ns=state.t_ns)
    note_closed(state, state.incident)
    for unit in state.units.values():
        accountability.end(state, unit)
    return state.units.values()


def _assign(state: StationState, by: str, action: Assign) -> Iterator[UnitState]:
    unit = _registered(state, action.unit_id)
    before, duty = unit.person, None
    for other in state.units.values():
        if other is not unit and other.person and other.person.person_id == action.person_id:
            duty = other.duty
            yield _without_wearer(state, other)
    same = before is not None and before.person_id == action.person_id
    if before is not None and not same:
        unit.end_wearing(state.t_ns)
    unit.person = Person(action.person_id, action.person_name, action.crew, action.role)
    if not same:
        unit.worn_since_ns = state.t_ns
        if duty is None:
            accountability.begin(state, unit, by)
        else:  # with another unit, which is no word of theirs, and no rest
            unit.duty = duty
    yield unit


def _without_wearer(state: StationState, unit: UnitState) -> UnitState:
    unit.end_wearing(state.t_ns)
    accountability.end(state, unit)
    return unit


def _is_first(state: StationState) -> bool:
    """Whether a place that is said now is the first one that is said on a plan, of which nobody
    knows where it lies: people are where satellites have them.
    """
    pinned = any(pin.kind in {"place", "start"} for pin in state.pins.values())
    said = state.start_set or pinned or bool(state.beacons)
    return state.plan is not state.laid_plan and not said


def _anchor(action: SetAnchor) -> Anchor:
    _require_finite(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)
    if abs(action.lat_deg) > 90.0 or abs(action.lon_deg) > 180.0:
        raise UserError(f"{action.lat_deg}, {action.lon_deg} is no latitude and longitude")
    return Anchor(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)


def _pins_of(unit_ids: set[str]) -> PinsTouched:
    return PinsTouched(tuple(sorted(unit_ids)))


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
