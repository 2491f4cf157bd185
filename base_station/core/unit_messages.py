"""Messages of units: the stages that each passes, from admission to the alarms.

A tracking agent sends messages for a unit that does not track itself: they pass the same stages. A
position has stages of its own within ``apply`` (``positioning.FUSE``, ``positioning.LOCATE``).
"""

from __future__ import annotations

from typing import Any

import msgspec

from base_station.core import accountability
from base_station.core.alarms.alarm_manager import AlarmManager
from base_station.core.closed_incidents import closed_incidents_at
from base_station.core.commands import delivery_progress
from base_station.core.events import (
    ClosedIncidentChanged,
    CommandChanged,
    Output,
    PinsChanged,
    Received,
    UnitChanged,
)
from base_station.core.pins.sightings import note_sighting
from base_station.core.positioning.positioning import Positioning
from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import captured_ns, event_time_ns
from base_station.core.state.message_stream import Freshness, Link
from base_station.core.state.resolve_queue import request_resolve
from base_station.core.units.apply_message import apply, apply_fault, apply_late_temperature
from shared.channels import Channel, tracked_unit
from shared.clock import NS_PER_S
from shared.messages import (
    CommandReply,
    CommandState,
    EventKind,
    GpsFix,
    Heartbeat,
    Message,
    Position,
    Sighting,
    Status,
    Temperature,
    UnitDescription,
    UnitEvent,
)

MAX_UNREGISTERED = 200  # units that are not registered: more are counted only
LOCATION_MESSAGES = Position | GpsFix | Sighting
_APPLIED_WHEN_LATE = UnitEvent | CommandReply | Sighting | GpsFix
_DEFERRABLE = frozenset(
    {Status, Temperature, Heartbeat}
)  # repeated in a second, and slow to change


_LATER: Any = None  # set by a stage, and read by none before it


class MessageUpdate(msgspec.Struct, gc=False):
    """Message on its way into the state; a stage reads the fields that earlier stages have set."""

    state: StationState
    event: Received
    channel: Channel
    message: Message
    unit: UnitState = _LATER
    sender: UnitState = _LATER  # the unit, or the agent that tracks for it
    is_of_agent: bool = False
    freshness: Freshness = _LATER
    link_before: Link = _LATER
    outputs: list[Output] = []


class UnitMessages:
    """Applies messages of units to the live state."""

    def __init__(self, alarms: AlarmManager, positioning: Positioning) -> None:
        self._alarms = alarms
        self._positioning = positioning
        self._stages = (
            admit,
            order,
            check_agent,
            self.apply,
            note_closed_incident,
            note_change,
            self.review_alarms,
        )

    def step(self, state: StationState, event: Received, channel: Channel) -> list[Output]:
        """Pass a message through the stages; a stage that gives False ends it."""
        update = MessageUpdate(state, event, channel, event.message)
        for stage in self._stages:
            if not stage(update):
                break
        return update.outputs

    def apply(self, update: MessageUpdate) -> bool:
        """Apply a message about now, or about an earlier time."""
        state, unit, message = update.state, update.unit, update.message
        if update.is_of_agent and isinstance(message, Status):
            update.sender.status, update.sender.status_ns = message, state.t_ns
        elif update.is_of_agent and isinstance(message, UnitEvent):
            if message.kind is EventKind.FALL:  # a fault of the agent is its own
                apply(unit, message, state.t_ns)
        elif update.freshness == "new" or isinstance(message, _APPLIED_WHEN_LATE):
            apply(unit, message, state.t_ns)
            update.outputs = self._apply_to_station(state, unit, message)
        elif isinstance(message, Position) and unit.registered:
            update.outputs = self._positioning.fuse_late(state, unit, message)
        elif isinstance(message, Temperature):
            incident = state.incident_of(unit)
            opened_ns = 0 if incident is None else incident.opened_ns
            apply_late_temperature(unit, message, opened_ns, state.t_ns)
        return True

    def review_alarms(self, update: MessageUpdate) -> bool:
        """Apply the alarm rules that are triggered by such a message."""
        state, kind = update.state, type(update.message)
        if self._alarms.has_rule_for(kind):
            alarms = self._alarms.review(state, update.unit, kind)
            update.outputs += [alarm.change(state.next_header()) for alarm in alarms]
        return True

    def _apply_to_station(
        self, state: StationState, unit: UnitState, message: Message
    ) -> list[Output]:
        """Apply changes that go beyond the unit's own readings."""
        match message:
            case Position() if unit.registered:
                return self._positioning.fuse(state, unit, message)
            case GpsFix() if unit.registered:
                return self._positioning.apply_fix(state, unit, message)
            case Sighting():
                return self._note_sighting(state, unit, message)
            case CommandReply():
                return _note_reply(state, unit, message)
            case UnitDescription():
                changed = delivery_progress.note_outputs(state, unit)
                return [CommandChanged(command.command_id) for command in changed]
            case _:
                return []

    def _note_sighting(
        self, state: StationState, unit: UnitState, sighting: Sighting
    ) -> list[Output]:
        """Solve its pin at once, at most one a second: others wait, one unit a tick."""
        changed = note_sighting(state, unit, sighting)
        if not changed:
            return []
        site = state.sites[unit.site_id]
        if state.t_ns - site.sighting_solved_ns < NS_PER_S:
            for unit_id in changed:
                request_resolve(state.late, unit_id, state.t_ns)
            return [PinsChanged(tuple(sorted(changed)))]
        site.sighting_solved_ns = state.t_ns
        return self._positioning.solve_pins(state, changed)


def admit(update: MessageUpdate) -> bool:
    """Find the unit and the sender; units that are not registered are kept up to a number."""
    state, unit_id = update.state, update.event.unit_id
    state.counts.messages += 1
    unit = state.units.get(unit_id)
    if unit is not None:  # nearly always
        update.unit = update.sender = unit
        return True
    tracked = tracked_unit(unit_id)
    unit = state.units.get(tracked or unit_id) or _unregistered_unit(state, tracked or unit_id)
    if unit is None:
        state.counts.unregistered_dropped += 1
        return False
    update.unit = update.sender = unit
    if tracked is not None:
        if unit.tracker is None:
            unit.tracker = UnitState(update.message.header.unit_id)
        update.sender, update.is_of_agent = unit.tracker, True
    return True


def order(update: MessageUpdate) -> bool:
    """End repeated messages, and find out whether it is live.  An agent's message does not show
    that the unit itself has contact.
    """
    event, header, t_ns = update.event, update.message.header, update.state.t_ns
    if event.backfilled:
        update.freshness = update.sender.accept_backfilled(header.boot_id, header.seq)
    else:
        update.freshness = update.sender.accept(update.channel, header, t_ns)
    if update.freshness == "repeat":
        return False
    unit = update.unit
    update.link_before = unit.link
    if not update.is_of_agent:
        unit.link = unit.link_at(t_ns)
    return True


def check_agent(update: MessageUpdate) -> bool:
    """End messages of an agent that are not of the wearer: of a unit that tracks by itself, or of
    another kind than place, strides, falls and the agent's own faults.
    """
    if not update.is_of_agent:
        return True
    unit, message = update.unit, update.message
    if isinstance(message, UnitEvent):
        apply_fault(update.sender, message, update.state.t_ns)  # before the unit has come, too
    if not unit.is_tracked_remotely:
        return False
    if isinstance(message, Position):
        return update.freshness == "new" or unit.registered
    return isinstance(message, UnitEvent) or (
        isinstance(message, Status) and update.freshness == "new"
    )


def note_closed_incident(update: MessageUpdate) -> bool:
    """Note that a journal has brought data of an incident that was closed since."""
    state, message = update.state, update.message
    if not (update.event.backfilled and update.unit.registered and state.closed_incidents):
        return True
    if isinstance(message, LOCATION_MESSAGES):
        t_ns = captured_ns(update.sender.boots, message.header, state.t_ns)
        past = [] if t_ns is None else closed_incidents_at(state, t_ns)
        update.outputs += [ClosedIncidentChanged(one.incident_id) for one in past]
    return True


def note_change(update: MessageUpdate) -> bool:
    """Note that the consoles may have to show the unit differently."""
    unit = update.unit
    can_wait = type(update.message) in _DEFERRABLE and update.link_before == unit.link
    soon = update.is_of_agent or not can_wait
    update.outputs.append(UnitChanged(unit.unit_id, soon))
    return True


def _unregistered_unit(state: StationState, unit_id: str) -> UnitState | None:
    """A unit that is not registered: shown, and not used; None where there are too many."""
    if sum(not unit.registered for unit in state.units.values()) >= MAX_UNREGISTERED:
        return None
    return state.add_unit(unit_id)


def _note_reply(state: StationState, unit: UnitState, reply: CommandReply) -> list[Output]:
    event_ns = event_time_ns(unit.boots, reply.header, state.t_ns)  # it may come of a journal
    command = delivery_progress.note_reply(state, unit, reply, event_ns)
    if command is None:
        return []
    if reply.state is CommandState.ACKNOWLEDGED:
        by = command.deliveries[unit.unit_id].acknowledged_by
        accountability.record_answer(state, unit, command, "self", by, event_ns)
    return [CommandChanged(command.command_id)]
