"""The life of commands: queued, sent, received, acknowledged, refused or expired.

Every change follows from an event in the log: a person's action, the station's own ``Command``
as it went out on the bus, a unit's reply, or a tick.  Nothing but a reply that the wearer asked
for, or a person at the console, acknowledges a command.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from base_station.commands.state import Delivery, DeliveryState, Order, SentCommand
from base_station.live_state import FORGOTTEN, StationState, UnitState
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.messages import Command, CommandKind, CommandReply, CommandState
from shared.messages.station import ConfirmCommand, SendCommand

MOST_OPEN = 50  # and as many again for evacuations, which wait for nothing
CLOSED_KEPT = 10  # at hand; the log has all of them
REPLACED = "a later rate replaces it"
_NOT_THERE: frozenset[DeliveryState] = frozenset({"queued", "sent"})


def send(state: StationState, by: str, action: SendCommand) -> SentCommand:
    """A new command.  Raises UserError where it makes no sense or reaches nobody."""
    _check(state, action)
    command = SentCommand(
        command_id=action.command_id,
        kind=action.kind,
        text=action.text,
        position_rate_hz=action.position_rate_hz,
        issued_by=by,
        issued_ns=state.t_ns,
        expires_ns=state.t_ns + round(action.lasts_s * NS_PER_S),
        deliveries={unit.unit_id: Delivery(unit.unit_id) for unit in _addressed(state, action)},
    )
    _forget_oldest(state)
    state.commands[action.command_id] = command
    return command


def replace(state: StationState, later: SentCommand) -> Iterator[SentCommand]:
    """Of two rates the one that was given last holds: where the other is still on its way, its
    repeat would be applied behind it.
    """
    if later.kind is not CommandKind.SET_POSITION_RATE:
        return
    for command in state.commands.values():
        if command is later or command.kind is not later.kind:
            continue
        replaced = [one for one in _not_reached(command) if one.unit_id in later.deliveries]
        for delivery in replaced:
            delivery.refused_ns, delivery.reason = state.t_ns, REPLACED
        if replaced:
            yield command


def confirm(state: StationState, by: str, action: ConfirmCommand) -> SentCommand:
    """Somebody spoke to the wearer.  Raises UserError where there is nothing to confirm."""
    command = state.commands.get(action.command_id)
    delivery = command.deliveries.get(action.unit_id) if command is not None else None
    if command is None or delivery is None:
        raise UserError(f"no command {action.command_id} to {action.unit_id}")
    if not command.asks_wearer:
        raise UserError("nobody has to acknowledge such a command")
    if delivery.acknowledged_ns is not None:
        raise UserError(f"{delivery.acknowledged_by} has acknowledged it already")
    delivery.acknowledged_ns, delivery.acknowledged_by = state.t_ns, by
    return command


def note_sent(state: StationState, unit_id: str, sent: Command) -> SentCommand | None:
    """The station said it on the bus; None where that changes nothing."""
    found = _delivery(state, unit_id, sent.command_id)
    if found is None or found[1].sent_ns is not None:
        return None
    command, delivery = found
    delivery.sent_ns = state.t_ns
    return command


def note_reply(
    state: StationState, unit: UnitState, reply: CommandReply, said_ns: int | None
) -> SentCommand | None:
    """What a unit answered at ``said_ns``, None: nobody can tell when.  None where that changes
    nothing.
    """
    found = _delivery(state, unit.unit_id, reply.command_id)
    if found is None:
        return None
    command, delivery = found
    match reply.state:
        case CommandState.RECEIVED if delivery.received_ns is None:
            delivery.received_ns = state.t_ns
        case CommandState.ACKNOWLEDGED if delivery.acknowledged_ns is None:
            delivery.received_ns = delivery.received_ns or state.t_ns
            delivery.acknowledged_ns = state.t_ns
            delivery.acknowledged_by = unit.name_at(said_ns)
        case CommandState.REFUSED if delivery.refused_ns is None:
            delivery.refused_ns, delivery.reason = state.t_ns, reply.detail
        case _:
            return None
    return command


def expire(state: StationState) -> Iterator[SentCommand]:
    """At a tick: the commands whose time is over."""
    for command in state.commands.values():
        if state.t_ns < command.expires_ns or not command.is_open:
            continue
        for delivery in command.deliveries.values():
            if command.awaits(delivery):
                delivery.expired_ns = state.t_ns
        yield command


def forget(state: StationState, unit: UnitState) -> Iterator[SentCommand]:
    """Who of this unit's wearers acknowledged what, and texts to them.  Of a message nothing is
    left then: for whom it has not reached its time is over.  Texts to others may name them: the
    words go of what has reached all whom it goes to.
    """
    for command in state.commands.values():
        delivery, not_reached = command.deliveries.get(unit.unit_id), _not_reached(command)
        if delivery is None and (not_reached or not command.text):
            continue
        if delivery is not None:
            delivery.acknowledged_by = FORGOTTEN if delivery.acknowledged_by else ""
        command.text = FORGOTTEN if command.text else ""
        if command.kind is CommandKind.TEXT:
            for one in not_reached:
                one.expired_ns = state.t_ns
        yield command


def unanswered(state: StationState) -> tuple[Order, ...]:
    """What is to be said, and said again, until the units answer."""
    return tuple(
        Order(
            unit_id=delivery.unit_id,
            command_id=command.command_id,
            kind=command.kind,
            issued_by=command.issued_by,
            expires_ns=command.expires_ns,
            text="" if command.text == FORGOTTEN else command.text,
            position_rate_hz=command.position_rate_hz,
        )
        for command in state.commands.values()
        for delivery in _not_reached(command)
    )


def _check(state: StationState, action: SendCommand) -> None:
    if not action.command_id or action.command_id in state.commands:
        raise UserError(f"a command needs an id of its own, not {action.command_id!r}")
    if action.kind is CommandKind.UNKNOWN:
        raise UserError("this station does not know this kind of command")
    if action.kind is CommandKind.TEXT and not action.text.strip():
        raise UserError("a message needs a text")
    if not (math.isfinite(action.lasts_s) and 0.0 < action.lasts_s <= 86_400.0):
        raise UserError(f"a command lasts up to a day, not {action.lasts_s} s")
    if not math.isfinite(action.position_rate_hz):
        raise UserError("a position rate is no finite number")
    if sum(map(bool, (action.unit_id, action.crew, action.everyone))) != 1:
        raise UserError("say one of: a unit, a crew, everyone")
    most = 2 * MOST_OPEN if action.kind is CommandKind.EVACUATE else MOST_OPEN
    if sum(command.is_open for command in state.commands.values()) >= most:
        raise UserError(f"{most} commands are open; wait until some are answered")


def _addressed(state: StationState, action: SendCommand) -> list[UnitState]:
    """Everyone is whoever wears a unit, and every unit of ours that was heard and not switched off
    since.
    """
    ours = [unit for unit in state.units.values() if unit.registered]
    if action.unit_id:
        found = [unit for unit in ours if unit.unit_id == action.unit_id]
    elif action.crew:
        found = [unit for unit in ours if unit.person and unit.person.crew == action.crew]
    else:
        found = [unit for unit in ours if unit.person or _is_out(unit)]
    if not found:
        whom = action.unit_id or action.crew or "everyone"
        raise UserError(f"no registered unit can be told: {whom}")
    return found


def _is_out(unit: UnitState) -> bool:
    return unit.heard_ns is not None and unit.stopped_ns is None


def _delivery(
    state: StationState, unit_id: str, command_id: str
) -> tuple[SentCommand, Delivery] | None:
    command = state.commands.get(command_id)
    delivery = command.deliveries.get(unit_id) if command is not None else None
    return None if command is None or delivery is None else (command, delivery)


def _not_reached(command: SentCommand) -> list[Delivery]:
    """To whom it is still on its way, as far as is known."""
    return [one for one in command.deliveries.values() if command.state_of(one) in _NOT_THERE]


def _forget_oldest(state: StationState) -> None:
    closed = [one.command_id for one in state.commands.values() if not one.is_open]
    for command_id in closed[: max(0, len(closed) - CLOSED_KEPT + 1)]:
        del state.commands[command_id]
