"""Protocol between two stations: messages and bus keys.

Only stations may publish or subscribe under these keys (``security.pki.access``); they lie outside
``muster/v1``, so no subscription to that tree brings them.
"""

from __future__ import annotations

from typing import Literal, TypeVar

import msgspec

from base_station.core.log_position import LogPosition, Record
from shared.channels import STATIONS_ROOT
from shared.errors import WireError
from shared.messages.station import TakeOver

PROTOCOL = 3  # stations that differ in it do not pair

Role = Literal["waiting", "standby", "active"]
W = TypeVar("W")


class PeerHeartbeat(msgspec.Struct, frozen=True):
    """Heartbeat, sent several times a second: the station and its role."""

    station: str
    protocol: int
    role: Role
    term: int  # of the last take-over in its log
    place: LogPosition  # up to which it has the log
    preferred: bool
    run: int  # of its program; another number: it has started anew
    units: int  # that are linked, with whichever router
    url: str  # where consoles find it
    t_ns: int = 0  # station time there; 0: of a version without it


class ReplicationAck(msgspec.Struct, frozen=True):
    """A standby has this on its disk."""

    run: int  # of the leading station whose log it follows
    place: LogPosition


class LogAncestry(msgspec.Struct, frozen=True):
    """Origin of a station's log."""

    log_id: int  # the time of its first event; 0: it is empty
    take_overs: tuple[TakeOver, ...]
    place: LogPosition


class Batch(msgspec.Struct, frozen=True):
    """Events of the active station's log, in order."""

    records: tuple[Record, ...]


def key_of(station: str, what: str) -> str:
    return f"{STATIONS_ROOT}/{station}/{what}"


def pack(word: msgspec.Struct) -> bytes:
    return msgspec.msgpack.encode(word)


def unpack(payload: bytes, kind: type[W]) -> W:
    """Raises WireError where the bytes are something else."""
    try:
        return msgspec.msgpack.decode(payload, type=kind)
    except msgspec.MsgspecError as error:
        raise WireError(f"message of another station cannot be read: {error}") from error
