"""Everything a pipeline remembers, in bytes and back."""

from __future__ import annotations

import msgspec

from base_station.live_state import StationState


class Checkpoint(msgspec.Struct, frozen=True):
    """Everything the pipeline remembers."""

    state: StationState
    fuser: str
    fusers: dict[str, bytes]
    pinned: dict[str, bytes]

    def to_bytes(self) -> bytes:
        return msgspec.msgpack.encode(self)


def read_checkpoint(saved: bytes) -> Checkpoint | None:
    """None where another version of the program wrote it: the log has everything that matters."""
    try:
        return msgspec.msgpack.decode(saved, type=Checkpoint)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
