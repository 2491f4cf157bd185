"""Progress of commands at the units: sent by the station, and answered."""

from __future__ import annotations

from collections.abc import Iterator

from base_station.core.commands import order_ends
from base_station.core.commands.order_repeats import command_of, current_id
from base_station.core.state import StationState, UnitState
from base_station.core.state.command import AnsweredBy, Delivery, SentCommand
from shared.messages import LIGHT, SOUND, Command, CommandKind, CommandReply, CommandState


def note_sent(state: StationState, unit_id: str, sent: Command) -> SentCommand | None:
    """Record that the station sent it on the bus; None where that changes nothing."""
    if sent.kind is CommandKind.END_ORDER:
        order_ends.note_sent(state, unit_id, sent)
        return None
    found = delivery_of(state, unit_id, sent.command_id)
    if found is None or found[1].sent_ns is not None:
        return None
    command, delivery = found
    if sent.command_id != current_id(command, delivery):
        return None  # it was on its way when the order was sent again
    delivery.sent_ns = state.t_ns
    return command


def note_reply(
    state: StationState, unit: UnitState, reply: CommandReply, event_ns: int | None
) -> SentCommand | None:
    """Note a unit's answer of ``event_ns``, None: unknown.  Gives None where it changes nothing."""
    found = delivery_of(state, unit.unit_id, reply.command_id)
    if found is None:
        return order_ends.note_reply(state, unit.unit_id, reply)
    command, delivery = found
    is_current = reply.command_id == current_id(command, delivery)
    if not is_current and reply.state is not CommandState.ACKNOWLEDGED:
        return None  # of an earlier sending: the wearer is to be notified again
    match reply.state:
        case CommandState.RECEIVED if delivery.received_ns is None:
            delivery.received_ns = state.t_ns
        case CommandState.NOTIFIED if delivery.notified_ns is None or _is_louder(delivery, reply):
            delivery.received_ns = delivery.received_ns or state.t_ns
            delivery.notified_ns = delivery.notified_ns or state.t_ns
            _note_signal(delivery, reply)
        case CommandState.ACKNOWLEDGED if delivery.acknowledged_via != "self":
            delivery.received_ns = delivery.received_ns or state.t_ns
            acknowledge(delivery, state.t_ns, "self", unit.name_at(event_ns))
        case CommandState.REFUSED if delivery.refused_ns is None and not delivery.reason:
            delivery.refused_ns = state.t_ns
            delivery.set_reason(reply.reason)
        case _:
            return None
    return command


def note_outputs(state: StationState, unit: UnitState) -> Iterator[SentCommand]:
    """Note from a unit's description if it can notify its wearer of open commands."""
    for command in state.commands.values():
        delivery = command.deliveries.get(unit.unit_id)
        if delivery is None or delivery.can_be_notified == unit.can_be_notified:
            continue
        if command.awaits(delivery):
            delivery.can_be_notified = unit.can_be_notified
            yield command


def delivery_of(
    state: StationState, unit_id: str, command_id: str
) -> tuple[SentCommand, Delivery] | None:
    """Return the order with this id, or with this id of a repeat, and its progress at a unit."""
    command = command_of(state, command_id)
    delivery = command.deliveries.get(unit_id) if command is not None else None
    return None if command is None or delivery is None else (command, delivery)


def acknowledge(delivery: Delivery, t_ns: int, via: AnsweredBy, by: str) -> None:
    """Note an answer: its time, its way and its author."""
    delivery.acknowledged_ns, delivery.acknowledged_via, delivery.acknowledged_by = t_ns, via, by


def _is_louder(delivery: Delivery, reply: CommandReply) -> bool:
    """True if the unit, which signalled by light only, now signals by sound too."""
    return reply.detail == SOUND and delivery.signal == LIGHT


def _note_signal(delivery: Delivery, reply: CommandReply) -> None:
    if reply.detail == SOUND:
        delivery.signal = "sound"
    elif reply.detail == LIGHT:
        delivery.signal = "light"
