"""Which of what is said on the bus the station takes for its log and its pipeline."""

from __future__ import annotations

from enum import Enum

from base_station.events import Received, StationEvent
from base_station.live_state import StationState, UnitState
from shared.channels import Direction, Qos, parse_key, tracked_unit
from shared.errors import UnknownChannelError


class Heard(Enum):
    """What is to be done with a record from the bus."""

    LEAVE = "leave"  # it is not logged
    REPEATED = "repeated"  # it is in the log, live or out of the unit's journal
    KEEP = "keep"
    URGENT = "urgent"  # keep it, and bring it to the disk before anybody hears of it
    FORGED = "forged"  # somebody speaks as the station


def judge(key: str, event: StationEvent, state: StationState) -> Heard:
    """``event`` is what the record under ``key`` stands for.  What cannot be read is kept,
    counted and shown.
    """
    try:
        channel = parse_key(key)[1]
    except UnknownChannelError:
        return Heard.KEEP
    if not channel.logged:
        return Heard.LEAVE
    if channel.direction is Direction.STATION:
        return Heard.FORGED
    if channel.direction is Direction.UP and isinstance(event, Received) and _is_kept(event, state):
        return Heard.REPEATED
    return Heard.URGENT if channel.qos is Qos.ALERT else Heard.KEEP


def take_back(event: StationEvent, state: StationState) -> None:
    """The log did not take what was stepped.  It has been seen, and counts as missing: its unit
    keeps it, and it is fetched when there is room.
    """
    if isinstance(event, Received) and (sender := _sender_of(event, state)) is not None:
        sender.take_back(event.message.header)


def _is_kept(event: Received, state: StationState) -> bool:
    """Whether the message came before: on two ways, sent again by the network, or replayed."""
    sender = _sender_of(event, state)
    return sender is not None and sender.has(event.message.header)


def _sender_of(event: Received, state: StationState) -> UnitState | None:
    """A unit, or the agent that tracks for one."""
    tracked = tracked_unit(event.unit_id)
    unit = state.units.get(tracked or event.unit_id)
    return unit if unit is None or tracked is None else unit.tracker
