"""Which of what is said on the bus the station takes for its log and its pipeline."""

from __future__ import annotations

from enum import Enum

from base_station.events import MessageNumber, Received, StationEvent, number_of
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
        return _doubt(event, state) or Heard.KEEP
    if not channel.logged:
        return Heard.LEAVE
    if channel.direction is Direction.STATION:
        return Heard.FORGED
    doubt = _doubt(event, state) if channel.direction is Direction.UP else None
    return doubt or (Heard.URGENT if channel.qos is Qos.ALERT else Heard.KEEP)


def take_back(number: MessageNumber | None, state: StationState) -> None:
    """The log did not take what was stepped, or has it no more.  It has been seen, and counts as
    missing: its unit keeps it, and it is fetched when there is room.
    """
    if number is not None and (sender := state.sender(number[0])) is not None:
        sender.take_back(*number[1:])


def _doubt(event: StationEvent, state: StationState) -> Heard | None:
    """``REPEATED`` where the message came before: on two ways, sent again by the network, or
    replayed; ``WILD`` where there are more starts of its sender than can be.
    """
    number = number_of(event)
    if number is None:
        return None
    unit_id, boot_id, seq = number
    sender = state.sender(unit_id)
    if sender is None:
        return None
    if sender.has(boot_id, seq):
        return Heard.REPEATED
    is_live = isinstance(event, Received) and not event.backfilled
    return Heard.WILD if is_live and sender.starts_wildly(boot_id, event.t_ns) else None
