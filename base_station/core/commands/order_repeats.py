"""Orders that are sent again to the recipients without an answer.

A repeat has an id of its own, so that the unit notifies its wearer anew; its answers count for the
order that it repeats.  A unit whose wearer has answered that order answers the repeat at once.
"""

from __future__ import annotations

from base_station.core.state import StationState
from base_station.core.state.command import Delivery, SentCommand
from shared.clock import NS_PER_S
from shared.coded_text import Term, coded
from shared.errors import UserError
from shared.messages.station import SendCommand


def send_again(state: StationState, action: SendCommand) -> SentCommand:
    """Send an order again, to one unit or to all without an answer.

    Raises UserError where it has no recipient, or the order is over.
    """
    command = state.commands.get(action.repeats)
    if command is None:
        raise UserError(
            coded(
                "order-unknown", "there is no order {command} to send again", command=action.repeats
            )
        )
    if not command.asks_wearer:
        raise UserError(
            coded("order-not-repeatable", "only an order that asks for an answer can be sent again")
        )
    if command.ended_ns is not None:
        raise UserError(coded("order-over", "this order is over: give a new one"))
    recipients = [
        one for one in _unanswered_deliveries(command) if action.unit_id in ("", one.unit_id)
    ]
    if not recipients:
        raise UserError(
            coded(
                "order-answered",
                "{unit} has acknowledged it, or never had it",
                unit=action.unit_id or Term("everybody", "everybody"),
            )
        )
    command.repeat_ids.append(action.command_id)
    until_ns = max(command.expires_ns, state.t_ns + round(action.lasts_s * NS_PER_S))
    for delivery in recipients:
        delivery.repeat_id, delivery.repeated_ns = action.command_id, state.t_ns
        delivery.sent_ns = delivery.received_ns = delivery.notified_ns = None
        delivery.refused_ns = delivery.expired_ns = None
        delivery.expires_ns = until_ns
        delivery.set_reason("")
        delivery.can_be_notified = state.units[delivery.unit_id].can_be_notified
    return command


def command_of(state: StationState, command_id: str) -> SentCommand | None:
    """The order with this id, or the one that was sent again under it."""
    found = state.commands.get(command_id)
    if found is not None:
        return found
    return next((one for one in state.commands.values() if command_id in one.repeat_ids), None)


def current_id(command: SentCommand, delivery: Delivery) -> str:
    """Id under which the order goes to a unit now."""
    return delivery.repeat_id or command.command_id


def _unanswered_deliveries(command: SentCommand) -> list[Delivery]:
    return [one for one in command.deliveries.values() if one.acknowledged_ns is None]
