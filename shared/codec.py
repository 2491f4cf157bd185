"""Messages to bytes and back, by the channel table; the same bytes on the bus and in the log."""

from __future__ import annotations

from typing import Any

from google.protobuf.message import DecodeError
from google.protobuf.message import Message as WireMessage

from shared.channels import Channel
from shared.errors import UnknownSchemaError, WireError
from shared.messages import (
    SCHEMA_REVISION,
    AlarmChange,
    Command,
    CommandReply,
    ExternalMarkers,
    FusedPosition,
    GpsFix,
    Header,
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
from shared.messages.muster.v1 import (
    alarm_pb2,
    command_pb2,
    event_pb2,
    external_pb2,
    fused_pb2,
    gps_pb2,
    header_pb2,
    imu_pb2,
    position_pb2,
    sighting_pb2,
    station_pb2,
    status_pb2,
    temperature_pb2,
    unit_description_pb2,
)

WIRE_TYPES: dict[type[Message], type[WireMessage]] = {
    Position: position_pb2.Position,
    Status: status_pb2.Status,
    Temperature: temperature_pb2.Temperature,
    UnitDescription: unit_description_pb2.UnitDescription,
    RawImu: imu_pb2.ImuBatch,
    GpsFix: gps_pb2.GpsFix,
    Sighting: sighting_pb2.Sighting,
    UnitEvent: event_pb2.UnitEvent,
    Heartbeat: event_pb2.Heartbeat,
    Command: command_pb2.Command,
    CommandReply: command_pb2.CommandReply,
    FusedPosition: fused_pb2.FusedPosition,
    AlarmChange: alarm_pb2.AlarmChange,
    OperatorAction: station_pb2.OperatorAction,
    Tick: station_pb2.Tick,
    ExternalMarkers: external_pb2.ExternalMarkers,
}


def encode(message: Message) -> bytes:
    """The message's bytes on the bus and in the log."""
    return message.to_wire().SerializeToString()


def decode(channel: Channel, payload: bytes) -> Message:
    """The typed view of ``payload``.

    Raises WireError when the bytes are no such message, UnknownSchemaError when a newer
    program wrote them.
    """
    try:
        wire: Any = WIRE_TYPES[channel.message].FromString(payload)
    except DecodeError as error:
        raise WireError(f"{len(payload)} bytes are no {channel.name} message: {error}") from error
    header = wire.header
    schema = header.schema
    if schema == 0 or not header.unit_id:
        raise WireError(f"{len(payload)} bytes are no {channel.name} message: no header")
    if schema > SCHEMA_REVISION:
        raise UnknownSchemaError(
            f"a {channel.name} message of schema revision {schema}; this program knows up to "
            f"{SCHEMA_REVISION}: update it"
        )
    try:
        return channel.message.from_wire(wire)
    except ValueError as error:
        raise WireError(f"a {channel.name} message that makes no sense: {error}") from error


def header_of(payload: bytes) -> Header | None:
    """Header of a message, also where ``decode`` refuses the rest: every message begins with its
    header.  None: there is none.
    """
    try:
        wire = header_pb2.AnyMessage.FromString(payload).header
    except DecodeError:
        return None
    return Header.from_wire(wire) if wire.schema and wire.unit_id else None
