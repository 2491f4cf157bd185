"""Checkpoint of a pipeline: encoding and decoding of its whole state."""

from __future__ import annotations

import msgspec

from base_station.core.state import StationState


class Checkpoint(msgspec.Struct, frozen=True):
    """All that the pipeline keeps."""

    state: StationState
    fuser: str
    fusers: dict[str, bytes]
    pinned: dict[str, bytes]

    def to_bytes(self) -> bytes:
        return msgspec.msgpack.encode(self)


def read_checkpoint(saved: bytes) -> Checkpoint | None:
    """Decode a checkpoint; None for one of another version: the log is then applied from its
    beginning.
    """
    try:
        return msgspec.msgpack.decode(saved, type=Checkpoint)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
