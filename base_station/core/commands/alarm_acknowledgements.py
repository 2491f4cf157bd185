"""Alarm acknowledged: the unit notifies its wearer that an operator deals with the alarm.

It follows from the acknowledgement of an alarm about the wearer, and waits for the link as an order
does.  It ends with that alarm, and where the alarm is raised anew.  A mayday has a command of its
own (``mayday_acknowledgements``), which names the call.
"""

from __future__ import annotations

from collections.abc import Iterator

from base_station.core.commands import unit_commands
from base_station.core.state import Alarm, StationState, UnitState
from base_station.core.state.command import SentCommand
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages import AlarmState, CommandKind

# Alarms about the wearer's own condition.  A PAR and the work limit ask something of the wearer:
# the operator who deals with them speaks to the wearer anyway.
RULES_ABOUT_WEARER = frozenset({"fall", "no-motion", "heat", "heat-dose"})
ALARM_OVER = coded("order-alarm-over", "the alarm is over, or was raised anew")
_LASTS_NS = 3_600 * NS_PER_S  # later it would be of no use to the wearer


def acknowledge(state: StationState, by: str, alarm: Alarm, incident_id: str) -> SentCommand | None:
    """Create the command of an alarm that was acknowledged; None where it is not about the present
    wearer.
    """
    unit = state.units.get(alarm.unit_id)
    if alarm.rule not in RULES_ABOUT_WEARER or unit is None:
        return None
    if not _is_of_wearer(alarm, unit, state.t_ns):
        return None
    return unit_commands.create(
        state,
        CommandKind.ALARM_ACKNOWLEDGED,
        by,
        unit,
        _LASTS_NS,
        incident_id,
        alarm_id=alarm.alarm_id,
    )


def withdraw(state: StationState) -> Iterator[SentCommand]:
    """End those whose alarm is over: it would be wrong to notify the wearer of them now."""
    taken = {
        alarm.alarm_id: alarm.changed_ns
        for alarm in state.alarms.values()
        if alarm.state is AlarmState.ACKNOWLEDGED
    }
    for command in state.commands.values():
        if command.kind is not CommandKind.ALARM_ACKNOWLEDGED:
            continue
        if command.alarm_id in taken and taken[command.alarm_id] >= command.issued_ns:
            continue
        for delivery in command.deliveries.values():
            if command.awaits(delivery):
                delivery.expire(state.t_ns, ALARM_OVER)
                yield command


def _is_of_wearer(alarm: Alarm, unit: UnitState, t_ns: int) -> bool:
    worn_ns = unit.wearer.from_ns(alarm.last_raised_ns) if alarm.about is None else alarm.about
    return worn_ns == unit.wearer.from_ns(t_ns)
