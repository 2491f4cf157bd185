"""Operator actions: each changes the live state, or is refused with a reason."""

from __future__ import annotations

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
from base_station.core.pins.pin_registry import PinAction
from base_station.core.place_actions import PlaceActionHandler, pins_changed
from base_station.core.positioning.positioning import Positioning
from base_station.core.state import Alarm, StationState, UnitState
from base_station.core.state.command import SentCommand
from base_station.site.plan_reader import PlanReader
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages import CommandKind
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
        self._places = PlaceActionHandler(positioning, plans)

    def apply(self, state: StationState, by: str, action: Action) -> list[StateChange]:
        """Apply an action: gives the changes.  UserError where it can have no effect."""
        return list(self._state_changes(state, by, action))

    def _state_changes(self, state: StationState, by: str, action: Action) -> Iterable[StateChange]:
        if isinstance(action, PinAction):
            return self._places.pin(state, by, action)
        if isinstance(action, PeopleAction):
            return self._people_action(state, by, action)
        changes: Iterable[StateChange] = state.units.values()
        match action:
            case AcknowledgeAlarm() | ResolveAlarm():
                changes = self._alarm(state, by, action)
            case ReportProblem() | SetThresholds() | SetFuser():
                changes = self._station_action(state, action)
            case DoneApart() | ImportFile() | RemoveImport():
                changes = ()  # only for the log and the tables
            case RegisterUnit() | SetStart():
                changes = self._unit(state, action)
            case SetAnchor() | SetPlan() | SetReference():
                self._places.change_site(state, action)
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
            return self._places.start(state, action)
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
        yield pins_changed(self._positioning.begin_incident(state, site_id, before_ns))
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
                yield pins_changed(partners)

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
            pins_changed(pinned),
            NamesErased(),
        ]


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


def _or_raise(outcome: Alarm | str) -> Alarm:
    if isinstance(outcome, str):
        raise UserError(outcome)
    return outcome
