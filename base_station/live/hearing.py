"""Which of what is said on the bus the station takes for its log and its pipeline."""

from __future__ import annotations

from enum import Enum

from base_station.events import Received, StationEvent, number_of
from base_station.live_state import StationState
from shared.channels import Direction, Qos, parse_key
from shared.errors import UnknownChannelError


class Heard(Enum):
    """What is to be done with a record from the bus."""

    LEAVE = "leave"  # it is not logged
    REPEATED = "repeated"  # it is in the log, live or out of the unit's journal
    KEEP = "keep"
    URGENT = "urgent"  # keep it, and bring it to the disk before anybody hears of it
    FORGED = "forged"  # somebody speaks as the station
    WILD = "wild"  # of a program that starts again and again, as none does


def judge(key: str, event: StationEvent, state: StationState) -> Heard:
    """``event`` is what the record under ``key`` stands for.  What cannot be read is kept,
    counted and shown.
    """
    try:
        channel = parse_key(key)[1]
    except UnknownChannelError:
        return Heard.REPEATED if _is_kept(event, state) else Heard.KEEP
    if not channel.logged:
        return Heard.LEAVE
    if channel.direction is Direction.STATION:
        return Heard.FORGED
    if channel.direction is Direction.UP and _is_kept(event, state):
        return Heard.REPEATED
    if channel.direction is Direction.UP and _is_wild(event, state):
        return Heard.WILD
    return Heard.URGENT if channel.qos is Qos.ALERT else Heard.KEEP


def take_back(event: StationEvent, state: StationState) -> None:
    """The log did not take what was stepped.  It has been seen, and counts as missing: its unit
    keeps it, and it is fetched when there is room.
    """
    number = number_of(event)
    if number is not None and (sender := state.sender(number[0])) is not None:
        sender.take_back(*number[1:])


def _is_kept(event: StationEvent, state: StationState) -> bool:
    """Whether the message came before: on two ways, sent again by the network, or replayed."""
    number = number_of(event)
    if number is None:
        return False
    sender = state.sender(number[0])
    return sender is not None and sender.has(*number[1:])


def _is_wild(event: StationEvent, state: StationState) -> bool:
    if not isinstance(event, Received) or event.backfilled:
        return False
    header = event.message.header
    sender = state.sender(header.unit_id)
    return sender is not None and sender.starts_wildly(header.boot_id, event.t_ns)
