"""Admission: decides which messages from the bus go into the log and the pipeline."""

from __future__ import annotations

from enum import Enum

from base_station.core.events import MessageNumber, Received, StationEvent, number_of
from base_station.core.state import StationState
from shared.channels import STATION, UP, Qos, parse_key
from shared.coded_text import coded
from shared.errors import UnknownChannelError


class Admission(Enum):
    """Decision about a record from the bus."""

    IGNORE = "leave"  # it is not logged
    DUPLICATE = "repeated"  # it is in the log, live or out of the unit's journal
    ACCEPT = "keep"
    ACCEPT_URGENT = "urgent"  # keep it, and flush it to the disk before its effects are published
    FORGED = "forged"  # a sender claims to be the station
    RESTART_STORM = "wild"  # of a program that starts more often than is possible


def classify(key: str, event: StationEvent, state: StationState) -> Admission:
    """Decide about a message; ``event`` is the decoded record under ``key``. An unreadable record
    is kept, counted and shown.
    """
    try:
        channel = parse_key(key)[1]
    except UnknownChannelError:
        return _reason_to_drop(event, state) or Admission.ACCEPT
    if not channel.logged:
        return Admission.IGNORE
    if channel.direction is STATION:
        return Admission.FORGED
    reason = _reason_to_drop(event, state) if channel.direction is UP else None
    return reason or (Admission.ACCEPT_URGENT if channel.qos is Qos.ALERT else Admission.ACCEPT)


def mark_missing(number: MessageNumber | None, state: StationState) -> None:
    """Mark a message as missing which the log did not take or has lost.  It is fetched from its
    unit's journal when there is room.
    """
    if number is not None and (sender := state.sender(number[0])) is not None:
        sender.mark_missing(*number[1:])


def _reason_to_drop(event: StationEvent, state: StationState) -> Admission | None:
    """Return ``DUPLICATE`` for a message that came before (over two links, repeated by the network,
    or replayed), and ``RESTART_STORM`` if its sender has more starts than are possible.
    """
    number = number_of(event)
    if number is None:
        return None
    unit_id, boot_id, seq = number
    sender = state.sender(unit_id)
    if sender is None:
        return None
    if sender.has(boot_id, seq):
        return Admission.DUPLICATE
    is_live = isinstance(event, Received) and not event.backfilled
    return (
        Admission.RESTART_STORM
        if is_live and sender.is_restart_storm(boot_id, event.t_ns)
        else None
    )


def rejection_reason(admission: Admission, key: str) -> str:
    """Return a sentence about why a message is rejected; empty if its sender is not at fault."""
    if admission is Admission.FORGED:
        return coded(
            "sender-forged",
            "A sender on the bus claims to be the station ({key}): rejected",
            key=key,
        )
    if admission is Admission.RESTART_STORM:
        return coded(
            "restart-storm",
            "A unit's program starts more often than any does ({key}): left out",
            key=key,
        )
    return ""
