"""Schemas of a log's topics: the protobuf schema of each key, for any reader of MCAP."""

from __future__ import annotations

import re
from typing import Any

from foxglove_schemas_protobuf.CompressedAudio_pb2 import CompressedAudio
from foxglove_schemas_protobuf.GeoJSON_pb2 import GeoJSON
from foxglove_schemas_protobuf.LocationFix_pb2 import LocationFix
from foxglove_schemas_protobuf.Log_pb2 import Log
from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.message import DecodeError

from shared.channels import parse_key
from shared.codec import WIRE_TYPES
from shared.errors import UnknownChannelError
from shared.messages.muster.v1.header_pb2 import Header

FOXGLOVE = "foxglove/"  # topics made from others for Foxglove
CONSOLE = "console/"  # what consoles were shown, once a second: a replay plays it
DERIVED = (FOXGLOVE, CONSOLE)  # beginnings of topics that follow from the others
_DERIVED_TYPES: dict[str, Any] = {
    "audio": CompressedAudio,
    "location": LocationFix,
    "log": Log,
    "plan": GeoJSON,
}
PLAN_TOPIC = f"{FOXGLOVE}station/plan"
SNAPSHOT_TOPIC = f"{CONSOLE}snapshot"
TRAIL_TOPIC = f"{CONSOLE}trail"  # behind a snapshot: one unit's
DELTA_TOPIC = f"{CONSOLE}delta"
_AUDIO_TOPIC = re.compile(rf"{FOXGLOVE}radio/([A-Za-z0-9][A-Za-z0-9_-]{{0,31}})/audio")


def location_topic(unit_id: str) -> str:
    return f"{FOXGLOVE}{unit_id}/location"


def log_topic(unit_id: str) -> str:
    return f"{FOXGLOVE}{unit_id}/log"


def audio_topic(channel: str) -> str:
    """Schema of a radio channel.  It follows from nothing, but no reader of events wants it."""
    return f"{FOXGLOVE}radio/{channel}/audio"


def channel_of_audio(topic: str) -> str | None:
    """Name of the radio channel; None: the topic has no audio."""
    found = _AUDIO_TOPIC.fullmatch(topic)
    return None if found is None else found[1]


def is_derived(key: str) -> bool:
    """True if a topic only repeats what follows from others."""
    return key.startswith(DERIVED)


def is_console(key: str) -> bool:
    """True if a topic has what consoles were shown."""
    return key.startswith(CONSOLE)


def wire_type_of(key: str) -> Any | None:
    """The generated message class of a key's payloads; None where the key says nothing."""
    if is_derived(key):
        return _DERIVED_TYPES.get(key.rpartition("/")[2])
    try:
        return WIRE_TYPES[parse_key(key)[1].message]
    except UnknownChannelError:
        return None


def descriptor_set(wire_type: Any) -> bytes:
    """A serialised FileDescriptorSet of the message's file and all that it imports."""
    files = FileDescriptorSet()
    seen: set[str] = set()

    def add(file: FileDescriptor) -> None:
        if file.name not in seen:
            seen.add(file.name)
            for imported in file.dependencies:
                add(imported)
            file.CopyToProto(files.file.add())

    add(wire_type.DESCRIPTOR.file)
    return files.SerializeToString()


def sender_time_and_sequence(payload: bytes) -> tuple[int, int]:
    """``(t_utc_ns, seq)`` of a message's header, the first field of every message; (0, 0) where
    the bytes are no message of ours.
    """
    # Field 1, length-delimited; a header is shorter than 128 bytes for any valid unit id.
    if len(payload) < 2 or payload[0] != 0x0A or payload[1] > 0x7F:
        return 0, 0
    try:
        header = Header.FromString(payload[2 : 2 + payload[1]])
    except DecodeError:
        return 0, 0
    return max(header.t_utc_ns, 0), header.seq & 0xFFFFFFFF
