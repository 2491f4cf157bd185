"""All clear: the end of an evacuation, of which each wearer is notified.

For each member the last order counts: members who were ordered out again since get no all clear,
and earlier evacuations of its recipients end with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from base_station.core.state import StationState
from base_station.core.state.command import Delivery, SentCommand
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages import CommandKind
from shared.messages.station import SendCommand

ALL_CLEAR = coded("order-all-clear", "all clear before an answer")


def give(state: StationState, by: str, action: SendCommand) -> Iterator[SentCommand]:
    """End an evacuation; gives it, earlier ones that end too, and the all clear.

    Raises UserError where there is no such evacuation, or it is over, or all of its members were
    ordered out again.
    """
    ended = state.commands.get(action.ended_command_id)
    if ended is None or ended.kind is not CommandKind.EVACUATE:
        raise UserError(
            coded(
                "evacuation-unknown",
                "there is no evacuation {command} to end",
                command=action.ended_command_id,
            )
        )
    if ended.ended_ns is not None:
        raise UserError(coded("evacuation-over", "this evacuation is over already"))
    evacuations = [
        one
        for one in state.commands.values()
        if one.kind is CommandKind.EVACUATE and one.ended_ns is None
    ]
    place = evacuations.index(ended)
    ordered_again = {unit_id for one in evacuations[place + 1 :] for unit_id in one.deliveries}
    recipients = [unit_id for unit_id in ended.deliveries if unit_id not in ordered_again]
    if not recipients:
        raise UserError(
            coded(
                "evacuation-ordered-anew",
                "all of them were ordered out again since: end that evacuation",
            )
        )
    for evacuation in evacuations[: place + 1]:
        if _end_for(evacuation, recipients, action.command_id, state.t_ns) or evacuation is ended:
            yield evacuation
    _end_for_all(ended, state.t_ns)
    yield _all_clear_command(state, by, action, ended, recipients)


def is_delivered(state: StationState, delivery: Delivery) -> bool:
    """True if the unit has the all clear that has ended its evacuation, or will have it."""
    command = state.commands.get(delivery.all_clear_id)
    delivered = None if command is None else command.deliveries.get(delivery.unit_id)
    if command is None or delivered is None:
        return False
    return delivered.received_ns is not None or command.state_of(delivered) in {"queued", "sent"}


def _end_for(
    evacuation: SentCommand, unit_ids: Iterable[str], all_clear_id: str, t_ns: int
) -> bool:
    """End an evacuation for these units; True where it concerns any of them."""
    ended = [evacuation.deliveries[one] for one in unit_ids if one in evacuation.deliveries]
    for delivery in ended:
        delivery.all_clear_id = delivery.all_clear_id or all_clear_id
        _stop_waiting(evacuation, delivery, t_ns)
    if all(one.all_clear_id for one in evacuation.deliveries.values()):
        evacuation.ended_ns = t_ns
    return bool(ended)


def _end_for_all(evacuation: SentCommand, t_ns: int) -> None:
    """End it for all: members who were ordered out again have another evacuation to answer."""
    evacuation.ended_ns = t_ns
    for delivery in evacuation.deliveries.values():
        _stop_waiting(evacuation, delivery, t_ns)


def _stop_waiting(evacuation: SentCommand, delivery: Delivery, t_ns: int) -> None:
    if evacuation.awaits(delivery):
        delivery.expire(t_ns, ALL_CLEAR)


def _all_clear_command(
    state: StationState, by: str, action: SendCommand, ended: SentCommand, recipients: list[str]
) -> SentCommand:
    expiries_ns = (ended.expires_ns_of(one) for one in ended.deliveries.values())
    command = SentCommand(
        command_id=action.command_id,
        kind=CommandKind.ALL_CLEAR,
        text="",
        position_rate_hz=0.0,
        issued_by=by,
        issued_ns=state.t_ns,
        expires_ns=max(state.t_ns + round(action.lasts_s * NS_PER_S), *expiries_ns),
        deliveries={
            unit_id: Delivery(unit_id, can_be_notified=state.units[unit_id].can_be_notified)
            for unit_id in recipients
        },
        incident_id=ended.incident_id,
        ended_command_id=ended.command_id,
    )
    state.commands[command.command_id] = command
    return command
