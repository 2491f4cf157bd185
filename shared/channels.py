"""THE table of channels: what travels under which key, how often, how urgently, and whether
it is kept.  Liveness, logging, decoding and the documentation are derived from it.

Keys: ``muster/v1/{unit}/up/...`` from a unit, ``muster/v1/{unit}/alert/...`` from a unit and
urgent, ``muster/v1/{unit}/command/...`` to a unit (``all`` for every unit), and
``muster/v1/station/...`` what the station itself decides.  A message that the station fetched
later from a unit's journal is logged under ``muster/v1/{unit}/journal/...``, followed by what
its key would have been.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache

from shared.errors import ConfigError, UnknownChannelError
from shared.messages import (
    AlarmChange,
    Command,
    CommandReply,
    ExternalMarkers,
    FusedPosition,
    GpsFix,
    Heartbeat,
    Message,
    OperatorAction,
    Position,
    RawImu,
    Sighting,
    Status,
    Temperature,
    Tick,
    UnitDescription,
    UnitEvent,
)

ROOT = "muster/v1"
STATIONS_ROOT = "muster/stations/v1"  # what two stations say to each other; units neither
DEPARTMENT_ROOT = "muster/department/v1"  # what stations report to their department
EVERY_UNIT = "all"
NO_TRACKER = "none"  # in a description: the unit's tracking agent computes its positions
_KEYS_KNOWN = 16_384  # a thousand units' keys are parsed once
_BACKFILLED = "journal/"
_UNREAD = "unread/"
_TRACKER_OF = "@tracker"  # "@" is in no unit's id


class Qos(Enum):
    """Queueing of a channel's messages on their way."""

    LIVE = "live"  # dropped rather than delayed; the journal brings what was dropped
    ALERT = "alert"  # ahead of everything else, sent at once
    LOCAL = "local"  # never on the bus: the station's own, for its log and its console


class Direction(Enum):
    UP = "up"  # unit to station
    DOWN = "down"  # station to unit
    STATION = "station"  # inside the station


@dataclass(frozen=True, slots=True)
class Channel:
    """One row of the table."""

    name: str
    suffix: str  # the key after ``muster/v1/{unit}/``
    message: type[Message]
    direction: Direction
    qos: Qos
    rate_hz: float | None  # None: when something happens
    logged: bool
    stale_after_s: float | None  # None: silence means nothing

    def key(self, unit_id: str) -> str:
        return f"{ROOT}/{unit_id}/{self.suffix}"

    @property
    def regular_rate_hz(self) -> float:
        """Rate of a channel that has one."""
        assert self.rate_hz is not None
        return self.rate_hz


# For what every message passes: a member is looked up through its class ten times as slowly.
UP, DOWN, STATION = Direction.UP, Direction.DOWN, Direction.STATION
POSITION = Channel("position", "up/position", Position, UP, Qos.LIVE, 5.0, True, 10.0)
STATUS = Channel("status", "up/status", Status, UP, Qos.LIVE, 1.0, True, 10.0)
TEMPERATURE = Channel("temperature", "up/temperature", Temperature, UP, Qos.LIVE, 1.0, True, 10.0)
DESCRIPTION = Channel(
    "description", "up/description", UnitDescription, UP, Qos.LIVE, 1 / 60, True, None
)
GPS = Channel("gps", "up/gps", GpsFix, UP, Qos.LIVE, 1.0, True, None)
SIGHTING = Channel("sighting", "up/sighting", Sighting, UP, Qos.LIVE, None, True, None)
IMU = Channel("imu", "up/imu", RawImu, UP, Qos.LIVE, 20.0, True, None)
HEARTBEAT = Channel("heartbeat", "heartbeat", Heartbeat, UP, Qos.LIVE, 1.0, True, 10.0)
EVENT = Channel("event", "alert/event", UnitEvent, UP, Qos.ALERT, None, True, None)
REPLY = Channel("reply", "alert/reply", CommandReply, UP, Qos.ALERT, None, True, None)
COMMAND = Channel("command", "command/send", Command, DOWN, Qos.ALERT, None, True, None)
FUSED = Channel("fused", "fused", FusedPosition, STATION, Qos.LOCAL, 5.0, True, None)
ALARM = Channel("alarm", "alarm", AlarmChange, STATION, Qos.LOCAL, None, True, None)
OPERATOR = Channel("operator", "operator", OperatorAction, STATION, Qos.LOCAL, None, True, None)
TICK = Channel("tick", "tick", Tick, STATION, Qos.LOCAL, 1.0, True, None)
EXTERNAL = Channel("external", "external", ExternalMarkers, STATION, Qos.LOCAL, None, True, None)

CHANNELS: tuple[Channel, ...] = (
    POSITION,
    STATUS,
    TEMPERATURE,
    DESCRIPTION,
    GPS,
    SIGHTING,
    IMU,
    HEARTBEAT,
    EVENT,
    REPLY,
    COMMAND,
    FUSED,
    ALARM,
    OPERATOR,
    TICK,
    EXTERNAL,
)

_BY_SUFFIX = {channel.suffix: channel for channel in CHANNELS}
_BY_MESSAGE = {channel.message: channel for channel in CHANNELS}
_UNIT_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
_UNREAD_KEY = re.compile(rf"{ROOT}/([^/]+)/{_UNREAD}([0-9a-f]{{16}})/([0-9]{{1,19}})/")


def channel_of(message: Message) -> Channel:
    """The channel that carries messages of this type."""
    return _BY_MESSAGE[type(message)]


@lru_cache(maxsize=_KEYS_KNOWN)
def parse_key(key: str) -> tuple[str, Channel]:
    """``(unit_id, channel)`` of a key; UnknownChannelError where no row of the table has it."""
    parts = key.split("/", 3)
    if len(parts) == 4 and f"{parts[0]}/{parts[1]}" == ROOT:
        channel = _BY_SUFFIX.get(parts[3].removeprefix(_BACKFILLED))
        if channel is not None:
            return parts[2], channel
    raise UnknownChannelError(f"no channel has the key {key!r}")


def backfilled_key(unit_id: str, suffix: str) -> str:
    """The key under which a message out of a unit's journal is logged."""
    return f"{ROOT}/{unit_id}/{_BACKFILLED}{suffix}"


@lru_cache(maxsize=_KEYS_KNOWN)
def is_backfilled(key: str) -> bool:
    """True if a logged message came out of a unit's journal rather than live."""
    parts = key.split("/", 3)
    return len(parts) == 4 and parts[3].startswith(_BACKFILLED)


def unread_key(unit_id: str, boot_id: int, seq: int, suffix: str) -> str:
    """The key under which bytes out of a unit's journal are logged that do not say themselves
    which of its messages they were.
    """
    return f"{ROOT}/{unit_id}/{_UNREAD}{boot_id:016x}/{seq}/{suffix}"


def parse_unread_key(key: str) -> tuple[str, int, int] | None:
    """``(unit_id, boot_id, seq)``; None: it is no such key."""
    match = _UNREAD_KEY.match(key)
    return None if match is None else (match[1], int(match[2], 16), int(match[3]))


def alive_key(unit_id: str) -> str:
    """The key of the liveliness token that a unit holds while it is linked."""
    return f"{ROOT}/{unit_id}/alive"


def journal_keys(unit_id: str) -> str:
    """The key expression under which a unit answers for its journal."""
    return f"{ROOT}/{unit_id}/journal/**"


def raw_journal_key(unit_id: str) -> str:
    """The key under which raw samples are fetched from a unit's journal."""
    return f"{ROOT}/{unit_id}/journal/raw"


def clock_key(unit_id: str) -> str:
    """The key under which a unit asks for the station's time."""
    return f"{ROOT}/{unit_id}/clock"


def department_summary_key(station: str) -> str:
    """The key of a station's summaries for its department."""
    return f"{DEPARTMENT_ROOT}/{station}/summary"


def department_events_key(station: str) -> str:
    """The key under which a station hands its events to its department, as queries."""
    return f"{DEPARTMENT_ROOT}/{station}/events"


def reporting_station(key: str) -> str:
    """The station that a key of a department is of; raises UnknownChannelError."""
    root, _, rest = key.partition(f"{DEPARTMENT_ROOT}/")
    station, _, what = rest.partition("/")
    if root or not station or what not in ("summary", "events"):
        raise UnknownChannelError(f"{key!r} is no key of a department")
    return station


def tracker_id(unit_id: str) -> str:
    """The id under which a unit's tracking agent speaks; no unit can have it."""
    return unit_id + _TRACKER_OF


def tracked_unit(sender_id: str) -> str | None:
    """The unit that the tracking agent with this id tracks for; None of any other sender."""
    return sender_id.removesuffix(_TRACKER_OF) if sender_id.endswith(_TRACKER_OF) else None


def validate_unit_id(unit_id: str) -> str:
    """Return ``unit_id`` when it can stand in a key, else raise ConfigError."""
    if _UNIT_ID.fullmatch(unit_id) is None or unit_id in (EVERY_UNIT, "station"):
        raise ConfigError(
            f"unit id {unit_id!r} cannot be used: take 1 to 64 letters, digits, '-', '_' or '.', "
            "beginning with a letter or digit, and neither 'all' nor 'station'"
        )
    return unit_id
