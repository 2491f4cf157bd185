"""Events that the pipeline applies, live or from a log, and the outputs of a step.  A log record is
``(t_ns, key, payload)``; ``event_of`` decodes it to an event.  Ticks and operators' actions are
records under ``muster/v1/station/...`` like any other message, so that a log replays without other
input.
"""

from __future__ import annotations

import msgspec

from shared.channels import (
    ALARM,
    DOWN,
    FUSED,
    ROOT,
    UP,
    is_backfilled,
    parse_key,
    parse_unread_key,
)
from shared.codec import decode, header_of
from shared.errors import WireError
from shared.messages import STATION_ID, AlarmChange, FusedPosition, Header, Message


class Received(msgspec.Struct, frozen=True, gc=False):
    """Message that was decoded."""

    t_ns: int  # station time (UTC, never going back) at which it came
    unit_id: str  # from the key: sender of a message, or recipient of a command
    message: Message
    backfilled: bool = False  # fetched later from the unit's journal


MessageNumber = tuple[str, int, int]  # unit, boot, sequence number: names it for ever


class Rejected(msgspec.Struct, frozen=True):
    """Bytes that could not be read; they are in the log all the same."""

    t_ns: int
    key: str
    reason: str
    number: MessageNumber | None = None  # which of its sender's messages it is, where that is known


StationEvent = Received | Rejected


class UnitChanged(msgspec.Struct, frozen=True, gc=False):
    """Change of a unit that the console may show."""

    unit_id: str
    soon: bool = True  # else it may wait until the unit is shown anyway, or a second


class TrailBackfilled(msgspec.Struct, frozen=True):
    """Points that came late were put into this unit's trail."""

    unit_id: str


class PinsChanged(msgspec.Struct, frozen=True):
    """Pins or beacons changed, and with them the paths of these units."""

    unit_ids: tuple[str, ...]


class ClosedIncidentChanged(msgspec.Struct, frozen=True):
    """More data about the time of a closed incident."""

    incident_id: str


class IncidentOpened(msgspec.Struct, frozen=True):
    """An incident was opened on a site."""

    incident_id: str
    site_id: str


class MembershipChanged(msgspec.Struct, frozen=True):
    """A unit came to an open incident, or left it."""

    unit_id: str
    incident_id: str  # empty: it is in none
    t_ns: int


class ExternalMarkersChanged(msgspec.Struct, frozen=True):
    """People or markers of other teams changed."""


class CommandChanged(msgspec.Struct, frozen=True):
    """New command, or progress of one at a unit."""

    command_id: str


class NamesErased(msgspec.Struct, frozen=True):
    """Names were erased: consoles need a new snapshot, as they may show them."""


class Refused(msgspec.Struct, frozen=True):
    """Operator action without effect."""

    action_id: str
    reason: str  # for the operator


_DECISIONS = frozenset(channel.key(STATION_ID) for channel in (FUSED, ALARM))


def is_decision(key: str) -> bool:
    """Distinguish records derived by the live station (positions, alarms) from events."""
    return key in _DECISIONS


Output = (
    FusedPosition
    | AlarmChange
    | UnitChanged
    | TrailBackfilled
    | PinsChanged
    | ClosedIncidentChanged
    | IncidentOpened
    | MembershipChanged
    | CommandChanged
    | ExternalMarkersChanged
    | NamesErased
    | Refused
)


DECODER_FAILED = "the decoder failed"
# Differences of such times still have room in 64 bits, wherever they are kept.
MONOTONIC_MAX_NS = 2**60  # 36 years of a unit's running
UTC_MAX_NS = 2**62  # the year 2116


def event_of(t_ns: int, key: str, payload: bytes) -> StationEvent:
    """Decode a log record to its event; never raises, whatever a sender has sent."""
    try:
        unit_id, channel = parse_key(key)
        message = decode(channel, payload)
    except WireError as error:
        return _rejected(t_ns, key, payload, str(error))
    except Exception as error:  # noqa: BLE001  # a bug of the decoder must not lose the message
        return _rejected(t_ns, key, payload, f"{DECODER_FAILED}: {error!r}")
    speaker = STATION_ID if channel.direction is DOWN else unit_id
    if message.header.unit_id != speaker:
        return Rejected(
            t_ns, key, f"{message.header.unit_id!r} speaks under the key of {unit_id!r}"
        )
    if channel.direction is UP and not _has_valid_times(message.header):
        return _rejected(t_ns, key, payload, f"the times of {speaker!r} make no sense")
    return Received(t_ns, unit_id, message, is_backfilled(key))


def number_of(event: StationEvent) -> MessageNumber | None:
    """Boot and sequence number of an event's message."""
    if isinstance(event, Received):  # nearly always
        header = event.message.header
        return event.unit_id, header.boot_id, header.seq
    return event.number


def number_in(key: str, payload: bytes) -> MessageNumber | None:
    """The same for a record, without decoding the rest of it."""
    unread = parse_unread_key(key)
    if unread is not None:
        return unread
    header = header_of(payload)
    if header is None or not key.startswith(f"{ROOT}/{header.unit_id}/"):
        return None
    return header.unit_id, header.boot_id, header.seq


def _rejected(t_ns: int, key: str, payload: bytes, reason: str) -> Rejected:
    """Event of a message of a newer program, or a damaged one: by its number it is not missing."""
    return Rejected(t_ns, key, reason, number_in(key, payload))


def _has_valid_times(header: Header) -> bool:
    return abs(header.t_mono_ns) < MONOTONIC_MAX_NS and 0 <= header.t_utc_ns < UTC_MAX_NS
