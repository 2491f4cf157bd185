"""Operator actions: each changes the live state, or is refused with a reason."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import assert_never

from base_station.core import accountability, idempotency
from base_station.core.alarms.alarm_manager import AlarmManager
from base_station.core.closed_incidents import last_closed_ns
from base_station.core.commands import (
    alarm_acknowledgements,
    all_clears,
    command_tracker,
    mayday_acknowledgements,
    order_ends,
    order_repeats,
)
from base_station.core.events import (
    ClosedIncidentChanged,
    NamesErased,
    PinsChanged,
    TrailBackfilled,
)
from base_station.core.people_actions import (
    PeopleAction,
    apply_people_action,
)
from base_station.core.pins import pin_registry
from base_station.core.pins.incident_scope import concerns_closed_incident
from base_station.core.pins.pin_registry import PinAction, change_pins, units_of
from base_station.core.positioning.positioning import Positioning
from base_station.core.state import Alarm, SiteState, StationState, UnitState
from base_station.core.state.command import SentCommand
from base_station.core.state.resolve_queue import request_resolve
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.interface import Start
from base_station.site.plan_reader import PlanReader
from shared.coded_text import coded
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages import CommandKind
from shared.messages.pins import PlaceBeacon, SetPin, StartTogether
from shared.messages.station import (
    AcknowledgeAlarm,
    Action,
    BeginErasure,
    CloseIncident,
    ConfirmCommand,
    DoneApart,
    ForgetWearers,
    ImportFile,
    OpenIncident,
    RegisterUnit,
    RemoveImport,
    ReportProblem,
    ResolveAlarm,
    SendCommand,
    SetAnchor,
    SetFuser,
    SetPlan,
    SetReference,
    SetStart,
    SetThresholds,
    TakeOver,
    UndoConfirmation,
)

# Changes by an action.
StateChange = (
    Alarm
    | UnitState
    | SentCommand
    | PinsChanged
    | ClosedIncidentChanged
    | TrailBackfilled
    | NamesErased
)


class ActionHandler:
    """Applies operators' actions to the live state."""

    def __init__(self, alarms: AlarmManager, positioning: Positioning, plans: PlanReader) -> None:
        self._alarms = alarms
        self._positioning = positioning
        self._plans = plans

    def apply(self, state: StationState, by: str, action: Action) -> list[StateChange]:
        """Apply an action: gives the changes.  UserError where it can have no effect."""
        return list(self._state_changes(state, by, action))

    def _state_changes(self, state: StationState, by: str, action: Action) -> Iterable[StateChange]:
        if isinstance(action, PinAction):
            return self._pin(state, by, action)
        if isinstance(action, PeopleAction):
            return self._people_action(state, by, action)
        changes: Iterable[StateChange] = state.units.values()
        match action:
            case AcknowledgeAlarm() | ResolveAlarm():
                changes = self._alarm(state, by, action)
            case ReportProblem() | SetThresholds() | SetFuser():
                changes = self._station_action(state, action)
            case DoneApart() | ImportFile() | RemoveImport():
                changes = ()  # the log and the tables have it
            case RegisterUnit() | SetStart():
                changes = self._unit(state, action)
            case SetAnchor() | SetPlan() | SetReference():
                self._site(state, action)
            case TakeOver():
                state.take_overs.append(action)
            case SendCommand() | ConfirmCommand():
                changes = self._command(state, by, action)
            case UndoConfirmation():
                changes = self._undo(state, action)
            case ForgetWearers() | BeginErasure():
                changes = self._erase(state, action)
            case _:
                assert_never(action)
        return changes

    def _people_action(
        self, state: StationState, by: str, action: PeopleAction
    ) -> Iterable[StateChange]:
        match action:
            case OpenIncident():
                return self._open(state, by, action)
            case CloseIncident():
                return self._close(state, by, action)
            case _:
                units = list(apply_people_action(state, by, action))
                moved = list(self._follow_incidents(state, units))
                return [*moved, *self._with_alarms(state, units)]

    def _site(self, state: StationState, action: SetAnchor | SetPlan | SetReference) -> None:
        site_id = state.site_id_of(action.incident_id)
        site = state.sites[site_id]
        if isinstance(action, SetAnchor):
            self._positioning.set_anchor(state, site_id, _anchor(action))
        elif isinstance(action, SetReference):
            _require_finite(action.down_m)
            unit_id = state.registered_unit(action.unit_id).unit_id if action.unit_id else None
            site.barometers.set_reference(unit_id, action.down_m)
            site.common_mode_error = CommonModeError()
        else:
            site.plan = self._plans.plan(action.geojson)
            self._positioning.replace_map(state, site_id)
            for unit_id in sorted(set().union(*map(units_of, site.pins.values()))):
                request_resolve(state.late, unit_id, state.t_ns)  # one by one: live goes first

    def _pin(self, state: StationState, by: str, action: PinAction) -> Iterator[StateChange]:
        site_id = _site_of_place(state, action)
        is_first = site_id is not None and _is_first_known_place(state.sites[site_id])
        debriefed = [
            one.incident_id
            for one in state.incidents.values()
            if one.closed_ns is not None
            and concerns_closed_incident(state, one.site_id, action, one.closed_ns)
        ]
        changed = change_pins(state, by, action)
        yield from map(ClosedIncidentChanged, debriefed)
        if site_id is not None and is_first:
            moved = self._positioning.switch_to_plan_frame(state, site_id)
            yield from map(TrailBackfilled, sorted(moved))
            changed |= moved
        yield _pins_changed(changed)

    def _alarm(
        self, state: StationState, by: str, action: AcknowledgeAlarm | ResolveAlarm
    ) -> Iterator[StateChange]:
        if isinstance(action, ResolveAlarm):
            yield _or_raise(self._alarms.resolve(state, by, action))
            return
        alarm = _or_raise(self._alarms.acknowledge(state, by, action))
        yield alarm
        incident = state.open_incident_of(state.units[alarm.unit_id]) if alarm.unit_id else None
        incident_id = "" if incident is None else incident.incident_id
        for of_rule in (mayday_acknowledgements, alarm_acknowledgements):
            command = of_rule.acknowledge(state, by, alarm, incident_id)
            if command is not None:
                yield command

    def _station_action(
        self, state: StationState, action: ReportProblem | SetThresholds | SetFuser
    ) -> Iterator[StateChange]:
        """Apply an action of the station itself."""
        if isinstance(action, ReportProblem):
            yield from self._alarms.report_problem(state, action)
        elif isinstance(action, SetThresholds):
            state.thresholds = action.thresholds
            self._alarms.use_thresholds(action.thresholds)
            yield from self._with_alarms(state, state.units.values())
        elif isinstance(action, SetFuser):
            yield PinsChanged(tuple(sorted(self._positioning.use_fuser(state, action.name))))

    def _unit(self, state: StationState, action: RegisterUnit | SetStart) -> Iterator[StateChange]:
        if isinstance(action, SetStart):
            return self._start(state, action)
        return self._register(state, action)

    def _register(self, state: StationState, action: RegisterUnit) -> Iterator[StateChange]:
        unit = state.units.get(action.unit_id)
        if unit is None:
            unit = state.add_unit(action.unit_id)
        unit.registered, unit.label = True, action.label
        yield from self._with_alarms(state, [unit])

    def _with_alarms(
        self, state: StationState, units: Iterable[UnitState]
    ) -> Iterator[StateChange]:
        """Units that changed, and the alarms that this raises or resolves."""
        for unit in units:
            yield unit
            yield from self._alarms.review(state, unit)

    def _command(
        self, state: StationState, by: str, action: SendCommand | ConfirmCommand
    ) -> Iterator[StateChange]:
        if isinstance(action, SendCommand) and (action.repeats or action.ended_command_id):
            yield from _earlier_order(state, by, action)
            return
        if isinstance(action, SendCommand):
            command = command_tracker.send(state, by, action)
            yield from command_tracker.replace(state, command)
            touched = list(accountability.ask(state, command))
        else:
            command = command_tracker.confirm(state, by, action)
            unit = state.units[action.unit_id]
            touched = accountability.record_answer(state, unit, command, "radio", by, state.t_ns)
        yield command
        yield from self._with_alarms(state, touched)

    def _undo(self, state: StationState, action: UndoConfirmation) -> Iterator[StateChange]:
        command = command_tracker.undo(state, action)
        units = accountability.undo(state, action)
        if command is None and not units:
            raise UserError(
                coded("nothing-to-undo", "there is no confirmation by radio under this id to undo")
            )
        if command is not None:
            yield command
        yield from self._with_alarms(state, units)

    def _close(self, state: StationState, by: str, action: CloseIncident) -> Iterator[StateChange]:
        units = list(apply_people_action(state, by, action))
        yield from command_tracker.withdraw(state, action.incident_id)
        yield from self._with_alarms(state, units)

    def _open(self, state: StationState, by: str, action: OpenIncident) -> Iterator[StateChange]:
        units = list(apply_people_action(state, by, action))
        site_id = state.incidents[action.incident_id].site_id
        yield from self._follow_incidents(state, units)
        self._positioning.keep_sites(state)
        self._positioning.set_map(state, site_id)
        before_ns = last_closed_ns(state, site_id)
        yield _pins_changed(self._positioning.begin_incident(state, site_id, before_ns))
        yield from self._with_alarms(state, units)

    def _follow_incidents(
        self, state: StationState, units: Iterable[UnitState]
    ) -> Iterator[StateChange]:
        """Bring units to the sites of their incidents: their paths begin there."""
        for unit in units:
            site_id = state.site_id_of(unit.incident_id)
            if site_id != unit.site_id:
                partners = self._positioning.move(state, unit, site_id)
                yield TrailBackfilled(unit.unit_id)
                yield _pins_changed(partners)

    def _erase(
        self, state: StationState, action: ForgetWearers | BeginErasure
    ) -> list[StateChange]:
        if state.open_incidents:
            raise UserError(coded("incident-open-meanwhile", "an incident is open; close it first"))
        if isinstance(action, BeginErasure):
            return []  # the erasure service rewrites the log before it
        unit = state.registered_unit(action.unit_id)
        self._positioning.forget(state, unit)
        pinned = pin_registry.forget(state, unit.unit_id)
        self._alarms.erase_names(state, unit)
        idempotency.erase_reasons(state)
        unit.wearer.erase_names()
        commands = command_tracker.erase_names(state, unit)
        return [
            unit,
            TrailBackfilled(unit.unit_id),
            *commands,
            _pins_changed(pinned),
            NamesErased(),
        ]

    def _start(self, state: StationState, action: SetStart) -> Iterator[StateChange]:
        unit = state.registered_unit(action.unit_id)
        _require_finite(action.north_m, action.east_m, action.down_m, action.heading_rad)
        _require_finite(action.std_m, action.heading_std_rad)
        if action.std_m < 0.0 or action.heading_std_rad < 0.0:
            raise UserError(
                coded(
                    "start-uncertainty-negative",
                    "a start needs uncertainties that are not negative",
                )
            )
        start = Start(
            action.north_m,
            action.east_m,
            action.down_m,
            action.heading_rad,
            action.std_m,
            action.heading_std_rad,
        )
        touched = {unit.unit_id}
        if _is_first_known_place(state.sites[unit.site_id]):
            touched |= self._positioning.switch_to_plan_frame(state, unit.site_id)
        self._positioning.start(state, unit, start)
        yield _pins_changed(touched)
        yield from map(TrailBackfilled, sorted(touched))


def _earlier_order(state: StationState, by: str, action: SendCommand) -> Iterator[SentCommand]:
    """Send an order again, or end it."""
    command_tracker.check_new(state, action)
    if action.repeats:
        yield order_repeats.send_again(state, action)
    elif action.kind is CommandKind.ALL_CLEAR:
        yield from all_clears.give(state, by, action)
    elif action.kind is CommandKind.END_ORDER:
        yield order_ends.stop(state, action)
    else:
        raise UserError(coded("order-end-unknown", "an order ends by ALL_CLEAR or END_ORDER"))


def _site_of_place(state: StationState, action: PinAction) -> str | None:
    """Site on which an action gives a place; None where it gives none."""
    match action:
        case SetPin():
            unit_ids: tuple[str, ...] = (action.unit_id,)
        case StartTogether():
            unit_ids = action.unit_ids[:1]
        case PlaceBeacon():
            return state.site_id_of(action.incident_id)
        case _:
            return None
    return next((state.units[one].site_id for one in unit_ids if one in state.units), None)


def _is_first_known_place(site: SiteState) -> bool:
    """True if a place reported now is the first one on a plan that has not been placed on the
    Earth: so far the positions of people there come from satellites alone.
    """
    pinned = any(pin.kind in {"place", "start"} for pin in site.pins.values())
    is_known = site.start_set or pinned or bool(site.beacons)
    return site.plan is not site.placed_plan and not is_known


def _anchor(action: SetAnchor) -> Anchor:
    _require_finite(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)
    if abs(action.lat_deg) > 90.0 or abs(action.lon_deg) > 180.0:
        raise UserError(
            coded(
                "anchor-no-place",
                "{lat_deg}, {lon_deg} is no latitude and longitude",
                lat_deg=action.lat_deg,
                lon_deg=action.lon_deg,
            )
        )
    return Anchor(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)


def _pins_changed(unit_ids: set[str]) -> PinsChanged:
    return PinsChanged(tuple(sorted(unit_ids)))


def _or_raise(outcome: Alarm | str) -> Alarm:
    if isinstance(outcome, str):
        raise UserError(outcome)
    return outcome


def _require_finite(*values: float) -> None:
    if not all(math.isfinite(value) for value in values):
        raise UserError(coded("number-not-finite", "a coordinate or angle is no finite number"))
