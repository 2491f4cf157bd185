"""Which of what is said on the bus the station takes for its log and its pipeline."""

from __future__ import annotations

from enum import Enum

from base_station.live_state import StationState
from shared.channels import Channel, Direction, Qos, is_backfilled, parse_key, tracked_unit
from shared.codec import decode
from shared.errors import UnknownChannelError, WireError


class Heard(Enum):
    """What is to be done with a record from the bus."""

    LEAVE = "leave"  # it is not logged, or it is in the log
    KEEP = "keep"
    URGENT = "urgent"  # keep it, and bring it to the disk before anybody hears of it
    FORGED = "forged"  # somebody speaks as the station


def judge(key: str, payload: bytes, state: StationState) -> Heard:
    """What cannot be read is kept, counted and shown."""
    try:
        unit_id, channel = parse_key(key)
    except UnknownChannelError:
        return Heard.KEEP
    if not channel.logged:
        return Heard.LEAVE
    if channel.direction is Direction.STATION:
        return Heard.FORGED
    if is_backfilled(key) and _is_kept(unit_id, channel, payload, state):
        return Heard.LEAVE
    return Heard.URGENT if channel.qos is Qos.ALERT else Heard.KEEP


def _is_kept(unit_id: str, channel: Channel, payload: bytes, state: StationState) -> bool:
    """Whether what was fetched came live after all, while it was asked for."""
    try:
        message = decode(channel, payload)
    except WireError:
        return False
    tracked = tracked_unit(unit_id)
    unit = state.units.get(tracked or unit_id)
    sender = unit if unit is None or tracked is None else unit.tracker
    return sender is not None and sender.has(message.header)
