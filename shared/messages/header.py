"""Header of a message: sender, boot, sequence number, time."""

from __future__ import annotations

import msgspec

from shared.messages.muster.v1 import header_pb2
from shared.messages.quantise import unsigned_known

SCHEMA_REVISION = 1
STATION_ID = "station"


class Header(msgspec.Struct, frozen=True, gc=False):
    """First part of every message; ``(unit_id, boot_id, seq)`` names it for ever."""

    unit_id: str
    boot_id: int  # random 64 bits at each start of the sender
    seq: int  # from 1, one sequence a boot over all channels
    t_mono_ns: int  # capture time on the sender's monotonic clock
    t_utc_ns: int = 0  # capture time as the sender estimates UTC; 0 unknown
    utc_std_s: float = 0.0  # standard deviation of that estimate; 0 unknown
    schema: int = SCHEMA_REVISION

    def to_wire(self) -> header_pb2.Header:
        wire = header_pb2.Header()
        self.fill(wire)
        return wire

    def fill(self, wire: header_pb2.Header) -> None:
        """The same into a message that has one."""
        wire.schema, wire.unit_id = self.schema, self.unit_id
        wire.boot_id, wire.seq = self.boot_id, self.seq
        wire.t_mono_ns, wire.t_utc_ns = self.t_mono_ns, self.t_utc_ns
        if self.utc_std_s:
            wire.utc_std_ms = unsigned_known(self.utc_std_s, 1e3)

    @staticmethod
    def from_wire(wire: header_pb2.Header) -> Header:
        return Header(  # by place, which takes half as long
            wire.unit_id,
            wire.boot_id,
            wire.seq,
            wire.t_mono_ns,
            wire.t_utc_ns,
            wire.utc_std_ms * 1e-3,
            wire.schema,
        )
