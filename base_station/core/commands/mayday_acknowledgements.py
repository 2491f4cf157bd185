"""Mayday acknowledged: the unit notifies its wearer that an operator has seen the call.

It is created by the acknowledgement of the alarm, and waits for the link as an order does.  It
belongs to one call, and ends when that call is cancelled or followed by another, at the station and
in the unit.
"""

from __future__ import annotations

from collections.abc import Iterator

from base_station.core.commands import unit_commands
from base_station.core.state import Alarm, StationState, UnitState
from base_station.core.state.command import SentCommand
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages import CommandKind

MAYDAY_RULE = "mayday"
CANCELLED = coded("order-mayday-cancelled", "the member has cancelled the mayday")
CALLED_AGAIN = coded("order-mayday-again", "the member has called another mayday")
_LASTS_NS = 86_400 * NS_PER_S  # as long as any order may


def acknowledge(state: StationState, by: str, alarm: Alarm, incident_id: str) -> SentCommand | None:
    """Create the command of an acknowledged alarm; None where its mayday is over, or was a former
    wearer's.
    """
    unit = state.units.get(alarm.unit_id)
    if alarm.rule != MAYDAY_RULE or unit is None or not unit.mayday.is_active:
        return None
    if alarm.about != unit.wearer.from_ns(unit.mayday.dated_ns):
        return None
    return unit_commands.create(
        state,
        CommandKind.MAYDAY_ACKNOWLEDGED,
        by,
        unit,
        _LASTS_NS,
        incident_id,
        mayday_boot_id=unit.mayday.boot_id,
        mayday_seq=unit.mayday.seq,
    )


def withdraw(state: StationState) -> Iterator[SentCommand]:
    """End those whose mayday is over: it would be wrong to notify the wearer of them now."""
    for command in state.commands.values():
        if command.kind is not CommandKind.MAYDAY_ACKNOWLEDGED:
            continue
        for delivery in command.deliveries.values():
            reason = _end_reason(command, state.units[delivery.unit_id])
            if reason and command.awaits(delivery):
                delivery.expire(state.t_ns, reason)
                yield command


def _end_reason(command: SentCommand, unit: UnitState) -> str:
    """Return why its mayday is over; empty where it is not."""
    if not unit.mayday.is_active:
        return CANCELLED
    is_same = (command.mayday_boot_id, command.mayday_seq) == (unit.mayday.boot_id, unit.mayday.seq)
    return "" if is_same else CALLED_AGAIN
