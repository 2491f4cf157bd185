"""Ends of orders: sent to a unit that may still notify its wearer of an order that is over.

An order is over for a unit when its answer by radio was entered, when its incident was closed, or
when an operator has stopped the signal of a LOCATE.  After an all clear it is sent where the all
clear itself does not reach the unit: one of an earlier version refuses that.  The unit itself knows
of answers of the wearer and of expired orders.
"""

from __future__ import annotations

from collections.abc import Iterator

from base_station.core.commands import all_clears
from base_station.core.commands.all_clears import ALL_CLEAR
from base_station.core.commands.order_repeats import command_of, current_id
from base_station.core.state import StationState
from base_station.core.state.command import Delivery, Order, SentCommand
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages import Command, CommandKind, CommandReply
from shared.messages.station import SendCommand

WITHDRAWN = coded("order-withdrawn", "its incident was closed")
STOPPED = coded("order-stopped", "stopped at the station")


def stop(state: StationState, action: SendCommand) -> SentCommand:
    """Stop the signal of a LOCATE.  Raises UserError where none is on, or on its way."""
    command = state.commands.get(action.ended_command_id)
    if command is None or command.kind is not CommandKind.LOCATE:
        raise UserError(
            coded(
                "locate-unknown",
                "there is no LOCATE {command} to stop",
                command=action.ended_command_id,
            )
        )
    if not command.is_open:
        raise UserError(coded("locate-over", "no unit signals its place by this order any more"))
    command.ended_ns = state.t_ns
    for delivery in command.deliveries.values():
        if command.awaits(delivery):
            delivery.expire(state.t_ns, STOPPED)
    return command


def is_owed(state: StationState, command: SentCommand, delivery: Delivery) -> bool:
    """True if the end of the order is still to be sent to the unit."""
    is_over = delivery.acknowledged_via == "radio" or delivery.reason in {WITHDRAWN, STOPPED}
    if delivery.reason == ALL_CLEAR:
        is_over = not all_clears.is_delivered(state, delivery)
    may_notify = delivery.sent_ns is not None and delivery.refused_ns is None
    is_answered = delivery.ended_ns is not None
    return (
        command.notifies_wearer
        and is_over
        and may_notify
        and not is_answered
        and state.t_ns < command.expires_ns_of(delivery)
    )


def owed(state: StationState) -> Iterator[Order]:
    """Ends to send, and to repeat, until the units answer."""
    for command in state.commands.values():
        for delivery in command.deliveries.values():
            if is_owed(state, command, delivery):
                yield Order(
                    unit_id=delivery.unit_id,
                    command_id=_end_id(command, delivery),
                    kind=CommandKind.END_ORDER,
                    issued_by=delivery.acknowledged_by or command.issued_by,
                    expires_ns=command.expires_ns_of(delivery),
                    text="",
                    position_rate_hz=0.0,
                    ended_command_id=current_id(command, delivery),
                )


def note_sent(state: StationState, unit_id: str, sent: Command) -> None:
    """Note that the station has sent an end; if the order is open again, it is sent again."""
    command = command_of(state, sent.ended_command_id)
    delivery = None if command is None else command.deliveries.get(unit_id)
    if command is None or delivery is None:
        return
    delivery.end_sent_ns = state.t_ns
    if _end_id(command, delivery) != sent.command_id:
        send_again(delivery)


def send_again(delivery: Delivery) -> None:
    """Send an order again that is open again: the unit may have ended it."""
    if delivery.end_sent_ns is not None:
        delivery.sent_ns = delivery.received_ns = delivery.notified_ns = None
        delivery.end_sent_ns = delivery.ended_ns = None


def note_reply(state: StationState, unit_id: str, reply: CommandReply) -> SentCommand | None:
    """Note that a unit has answered an end; returns the order, None where nothing changes.  A unit
    of an earlier version refuses an end; it is then not sent again.
    """
    for command in state.commands.values():
        delivery = command.deliveries.get(unit_id)
        if delivery is None or delivery.ended_ns is not None:
            continue
        if _end_id(command, delivery) == reply.command_id:
            delivery.ended_ns = state.t_ns
            return command
    return None


def _end_id(command: SentCommand, delivery: Delivery) -> str:
    """Return an id that differs each time the order ends: an answer by radio can be undone and
    entered again.
    """
    return f"{command.command_id}:end:{delivery.acknowledged_ns or delivery.expired_ns}"
