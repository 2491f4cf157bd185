"""Packets of a channel in its log, as ``foxglove.CompressedAudio``."""

from __future__ import annotations

from typing import NamedTuple

from foxglove_schemas_protobuf.CompressedAudio_pb2 import CompressedAudio
from google.protobuf.message import DecodeError
from google.protobuf.timestamp_pb2 import Timestamp

from base_station.radio.opus import duration_ns
from shared.clock import NS_PER_S

_FORMAT = "opus"


class Packet(NamedTuple):
    """Opus packet; ``t_ns``: station time of its first sample."""

    t_ns: int
    data: bytes

    @property
    def end_ns(self) -> int:
        return self.t_ns + duration_ns(self.data)


def payload_of(packet: Packet) -> bytes:
    timestamp = Timestamp(seconds=packet.t_ns // NS_PER_S, nanos=packet.t_ns % NS_PER_S)
    audio = CompressedAudio(timestamp=timestamp, data=packet.data, format=_FORMAT)
    return audio.SerializeToString()


def packet_of(t_ns: int, payload: bytes) -> Packet | None:
    """None where it is not of this version."""
    try:
        audio = CompressedAudio.FromString(payload)
    except DecodeError:
        return None
    if audio.format != _FORMAT or not duration_ns(audio.data):
        return None
    return Packet(t_ns, audio.data)
