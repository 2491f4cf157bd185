"""Notices to the wearer that the state of the unit requires now."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from edge.agent.open_commands import OpenCommand
from edge.notifiers.signals import Notice, Signal
from shared.messages import CommandKind

PRE_ALERT_S, NO_MOTION_S = 20.0, 30.0  # without motion; the station's own, docs/concepts.md
_LINK_LOST_S = 30.0  # shorter losses, as behind walls, are not notified
_BATTERY_LOW = 0.2

_OF_COMMANDS = {
    CommandKind.EVACUATE: Signal.EVACUATE,
    CommandKind.PAR_REQUEST: Signal.PAR_REQUEST,
    CommandKind.TEXT: Signal.TEXT,
    CommandKind.LOCATE: Signal.LOCATE,
    CommandKind.ALL_CLEAR: Signal.ALL_CLEAR,
    CommandKind.ALARM_ACKNOWLEDGED: Signal.ALARM_ACKNOWLEDGED,
}


@dataclass(frozen=True, slots=True)
class WearerState:
    """State of a unit, as far as its wearer is notified of it."""

    motionless_s: float = 0.0
    is_worn: bool = False  # it has moved for a while: a unit on a shelf gives no alarm
    is_on_foot: bool = True
    battery: float | None = None  # 0 empty ... 1 full
    unlinked_s: float = 0.0  # 0: there is a link
    maydays_called: int = 0  # with this start of the agent
    maydays_received: int = 0  # of these, by the station
    mayday_acknowledgement: str = ""  # id of the station's command; empty: it has not come


def notices(state: WearerState, commands: Iterable[OpenCommand]) -> tuple[Notice, ...]:
    """Return the notices to show, the most urgent first."""
    found = (*_of_commands(commands), *_of_unit(state))
    return tuple(sorted(found, key=lambda notice: notice.signal.urgency))


def _of_commands(commands: Iterable[OpenCommand]) -> Iterator[Notice]:
    for command in commands:
        yield Notice(_OF_COMMANDS[command.kind], command.command_id, command.text)


def _of_unit(state: WearerState) -> Iterator[Notice]:
    if state.is_worn and state.motionless_s >= NO_MOTION_S:
        yield Notice(Signal.NO_MOTION)
    elif state.is_worn and state.motionless_s >= PRE_ALERT_S:
        yield Notice(Signal.PRE_ALERT)
    if state.maydays_called:
        yield Notice(Signal.MAYDAY_CALLED, str(state.maydays_called))
    if state.mayday_acknowledgement:  # so it has arrived
        yield Notice(Signal.MAYDAY_ACKNOWLEDGED, state.mayday_acknowledgement)
    elif state.maydays_received:
        yield Notice(Signal.MAYDAY_SENT, str(state.maydays_received))
    if not state.is_on_foot:
        yield Notice(Signal.NOT_ON_FOOT)
    if state.unlinked_s >= _LINK_LOST_S:
        yield Notice(Signal.LINK_LOST)
    if state.battery is not None and state.battery < _BATTERY_LOW:
        yield Notice(Signal.BATTERY_LOW)
