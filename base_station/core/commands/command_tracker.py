"""Command tracker: queued, sent, received, notified, acknowledged, refused or expired.

Every change follows from an event in the log: an operator action, the station's own ``Command``
as it went out on the bus, a unit's reply, or a tick.  Only a reply that the wearer asked for, or a
person at the console, acknowledges a command.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from base_station.core.commands import order_ends
from base_station.core.commands.delivery_progress import acknowledge, delivery_of
from base_station.core.commands.order_ends import WITHDRAWN
from base_station.core.commands.order_repeats import command_of, current_id
from base_station.core.state import ERASED_TEXT, StationState, UnitState
from base_station.core.state.command import (
    Delivery,
    DeliveryState,
    Order,
    SentCommand,
)
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages import (
    OF_STATION,
    CommandKind,
)
from shared.messages.station import ConfirmCommand, SendCommand, UndoConfirmation

MAX_OPEN = 50  # and as many again for evacuations, which wait for nothing
CLOSED_KEPT = 10  # in memory; the log has all of them
REPLACED = coded("order-replaced", "a later rate replaces it")
_NOT_RECEIVED: frozenset[DeliveryState] = frozenset({"queued", "sent"})


def send(state: StationState, by: str, action: SendCommand) -> SentCommand:
    """Create a new command.  Raises UserError where it is not valid or has no recipient."""
    _require_valid_command(state, action)
    recipients = _recipients(state, action)
    command = SentCommand(
        command_id=action.command_id,
        kind=action.kind,
        text=action.text,
        position_rate_hz=action.position_rate_hz,
        issued_by=by,
        issued_ns=state.t_ns,
        expires_ns=state.t_ns + round(action.lasts_s * NS_PER_S),
        deliveries={
            unit.unit_id: Delivery(unit.unit_id, can_be_notified=unit.can_be_notified)
            for unit in recipients
        },
        incident_id=_incident_of(state, recipients),
    )
    _drop_oldest_closed(state)
    state.commands[action.command_id] = command
    return command


def replace(state: StationState, later: SentCommand) -> Iterator[SentCommand]:
    """End the order of an earlier position rate: the last one counts, and a repeat of the earlier
    one would be applied after it.
    """
    if later.kind is not CommandKind.SET_POSITION_RATE:
        return
    for command in state.commands.values():
        if command is later or command.kind is not later.kind:
            continue
        replaced = [one for one in _undelivered(command) if one.unit_id in later.deliveries]
        for delivery in replaced:
            delivery.refused_ns = state.t_ns
            delivery.set_reason(REPLACED)
        if replaced:
            yield command


def confirm(state: StationState, by: str, action: ConfirmCommand) -> SentCommand:
    """Acknowledge by radio.  Raises UserError where there is nothing to confirm."""
    found = delivery_of(state, action.unit_id, action.command_id)
    if found is None:
        raise UserError(
            coded(
                "command-not-to-unit",
                "no command {command} to {unit}",
                command=action.command_id,
                unit=action.unit_id,
            )
        )
    command, delivery = found
    if not command.notifies_wearer:
        raise UserError(
            coded(
                "command-not-by-radio",
                "such a command concerns the unit alone: it is not answered by radio",
            )
        )
    if delivery.acknowledged_ns is not None:
        raise UserError(
            coded(
                "command-acknowledged",
                "{by} has acknowledged it already",
                by=delivery.acknowledged_by,
            )
        )
    acknowledge(delivery, state.t_ns, "radio", by)
    return command


def undo(state: StationState, action: UndoConfirmation) -> SentCommand | None:
    """Undo answers that were entered by radio, and wait for those members again; None: there are
    none.  Their units may have received the end of the command: it is sent again.

    Raises UserError where the incident of the command is closed.
    """
    command = state.commands.get(action.entry_id)
    if command is None:
        return None
    entered = [
        delivery
        for delivery in command.deliveries.values()
        if delivery.acknowledged_via == "radio" and action.unit_id in ("", delivery.unit_id)
    ]
    if entered and command.incident_id and not _is_open(state, command.incident_id):
        raise UserError(
            coded(
                "command-incident-closed",
                "its incident is closed: what was entered in it stays as it is",
            )
        )
    if entered and command.ended_ns is not None:
        raise UserError(
            coded("command-over", "the order is over: what was entered for it stays as it is")
        )
    for delivery in entered:
        delivery.acknowledged_ns, delivery.acknowledged_by = None, ""
        delivery.acknowledged_via = ""
        order_ends.send_again(delivery)
    return command if entered else None


def withdraw(state: StationState, incident_id: str) -> Iterator[SentCommand]:
    """End the orders of an incident with it: they are not sent to the unit of a member who comes
    to the next one.  The position rate of a unit is no order to a member, and stays.
    """
    incident = state.incidents[incident_id]
    for command in state.commands.values():
        is_of_it = command.incident_id == incident_id
        is_of_several = not command.incident_id and command.issued_ns > incident.opened_ns
        if not (is_of_it or is_of_several) or command.kind is CommandKind.SET_POSITION_RATE:
            continue
        open_ones = [
            one
            for one in command.deliveries.values()
            if command.awaits(one)
            and (is_of_it or state.units[one.unit_id].incident_id == incident_id)
        ]
        for delivery in open_ones:
            delivery.expire(state.t_ns, WITHDRAWN)
        is_standing = is_of_it and command.ended_ns is None
        if is_standing:
            command.ended_ns = state.t_ns
        if open_ones or is_standing:
            yield command


def expire(state: StationState) -> Iterator[SentCommand]:
    """At a tick, expire the commands whose time is over."""
    for command in state.commands.values():
        if state.t_ns < command.expires_ns or not command.is_open:
            continue
        over = [
            one
            for one in command.deliveries.values()
            if state.t_ns >= command.expires_ns_of(one) and command.awaits(one)
        ]
        for delivery in over:
            delivery.expired_ns = state.t_ns
        if over:
            yield command


def erase_names(state: StationState, unit: UnitState) -> Iterator[SentCommand]:
    """Erase acknowledgements of this unit's wearers, and texts to them.  A text to them ends for
    the recipients that it has not reached.  Texts to others may name them: texts that have reached
    all recipients are erased, too.
    """
    for command in state.commands.values():
        delivery, not_reached = command.deliveries.get(unit.unit_id), _undelivered(command)
        if delivery is None and (not_reached or not command.text):
            continue
        if delivery is not None:
            delivery.acknowledged_by = ERASED_TEXT if delivery.acknowledged_by else ""
        command.text = ERASED_TEXT if command.text else ""
        if command.kind is CommandKind.TEXT:
            for one in not_reached:
                one.expired_ns = state.t_ns
        yield command


def open_orders(state: StationState) -> tuple[Order, ...]:
    """Orders, and ends of orders, to send and to repeat until the units answer."""
    begun = (
        Order(
            unit_id=delivery.unit_id,
            command_id=current_id(command, delivery),
            kind=command.kind,
            issued_by=command.issued_by,
            expires_ns=command.expires_ns_of(delivery),
            text="" if command.text == ERASED_TEXT else command.text,
            position_rate_hz=command.position_rate_hz,
            mayday_boot_id=command.mayday_boot_id,
            mayday_seq=command.mayday_seq,
            ended_command_id=command.ended_command_id,
            repeats=command.command_id if delivery.repeat_id else "",
        )
        for command in state.commands.values()
        for delivery in _undelivered(command)
    )
    return (*begun, *order_ends.owed(state))


def _incident_of(state: StationState, units: Iterable[UnitState]) -> str:
    """Id of the open incident of all these units; empty: they are in none, or not in the same."""
    opened = {one.incident_id if (one := state.open_incident_of(unit)) else "" for unit in units}
    return opened.pop() if len(opened) == 1 else ""


def _is_open(state: StationState, incident_id: str) -> bool:
    return incident_id in {one.incident_id for one in state.open_incidents}


def check_new(state: StationState, action: SendCommand) -> None:
    """Raise UserError where an order has no id of its own, or no time in which it is answered."""
    if not action.command_id or command_of(state, action.command_id) is not None:
        raise UserError(
            coded(
                "command-id-taken",
                "a command needs an id of its own, not {command!r}",
                command=action.command_id,
            )
        )
    if not (math.isfinite(action.lasts_s) and 0.0 < action.lasts_s <= 86_400.0):
        raise UserError(
            coded(
                "command-lasts",
                "a command lasts up to a day, not {lasts_s} s",
                lasts_s=action.lasts_s,
            )
        )


def _require_valid_command(state: StationState, action: SendCommand) -> None:
    check_new(state, action)
    if action.kind is CommandKind.UNKNOWN:
        raise UserError(
            coded("command-kind-unknown", "this station does not know this kind of command")
        )
    if action.kind in OF_STATION:
        raise UserError(
            coded("command-of-station", "the station sends this by itself; it cannot be ordered")
        )
    if action.kind is CommandKind.ALL_CLEAR:
        raise UserError(coded("all-clear-names-none", "an all clear ends an evacuation: name that"))
    if action.kind is CommandKind.TEXT and not action.text.strip():
        raise UserError(coded("message-empty", "a message needs a text"))
    if not math.isfinite(action.position_rate_hz):
        raise UserError(coded("position-rate-not-finite", "a position rate is no finite number"))
    if sum(map(bool, (action.unit_id, action.crew, action.person_ids, action.everyone))) != 1:
        raise UserError(
            coded(
                "command-addressee",
                "say one of: a unit, a crew or floor that has members, everyone",
            )
        )
    most = 2 * MAX_OPEN if action.kind is CommandKind.EVACUATE else MAX_OPEN
    if sum(map(_is_open_order, state.commands.values())) >= most:
        raise UserError(
            coded(
                "commands-too-many",
                "{most} commands are open; wait until some are answered",
                most=most,
            )
        )


def _is_open_order(command: SentCommand) -> bool:
    return command.is_open and command.kind not in OF_STATION


def _recipients(state: StationState, action: SendCommand) -> list[UnitState]:
    """Recipients of a command.  Everyone: all wearers, and all registered units that have sent a
    message and were not switched off since; of the named incident, or else of all.
    """
    ours = [
        unit
        for unit in state.units.values()
        if unit.registered and action.incident_id in ("", unit.incident_id)
    ]
    if action.unit_id:
        found = [unit for unit in ours if unit.unit_id == action.unit_id]
    elif action.person_ids:
        found = [one for one in ours if one.wearer.person_id in action.person_ids]
    elif action.crew:
        found = [
            unit for unit in ours if unit.wearer.person and unit.wearer.person.crew == action.crew
        ]
    else:
        found = [unit for unit in ours if unit.wearer.person or _is_in_use(unit)]
    if not found:
        recipients = (
            action.unit_id or action.crew or ("the crew" if action.person_ids else "everyone")
        )
        raise UserError(
            coded(
                "command-recipients-none",
                "no registered unit can receive this: {recipients}",
                recipients=recipients,
            )
        )
    return found


def _is_in_use(unit: UnitState) -> bool:
    return unit.last_message_ns is not None and unit.stopped_ns is None


def _undelivered(command: SentCommand) -> list[Delivery]:
    """Return the recipients that have not confirmed its receipt."""
    return [one for one in command.deliveries.values() if command.state_of(one) in _NOT_RECEIVED]


def _drop_oldest_closed(state: StationState) -> None:
    """Drop the oldest closed commands; evacuations that stand are counted apart: they can still be
    ended.
    """
    closed = [one for one in state.commands.values() if _is_done_with(state, one)]
    standing = [one for one in closed if _is_open_evacuation(one)]
    over = [one for one in closed if not _is_open_evacuation(one)]
    for commands in (standing, over):
        for command in commands[: max(0, len(commands) - CLOSED_KEPT + 1)]:
            del state.commands[command.command_id]


def _is_done_with(state: StationState, command: SentCommand) -> bool:
    if command.is_open:
        return False
    return not any(order_ends.is_owed(state, command, one) for one in command.deliveries.values())


def _is_open_evacuation(command: SentCommand) -> bool:
    return command.kind is CommandKind.EVACUATE and command.ended_ns is None
