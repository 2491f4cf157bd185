"""Time as an event of the station's pipeline."""

from __future__ import annotations

import msgspec

from shared.messages.header import Header
from shared.messages.muster.v1 import station_pb2


class Tick(msgspec.Struct, frozen=True):
    """Whatever the pipeline does because time passed, it does at a tick."""

    header: Header
    t_ns: int  # station time
    unlinked: tuple[str, ...] = ()  # units whose link was there and is gone

    def to_wire(self) -> station_pb2.Tick:
        return station_pb2.Tick(
            header=self.header.to_wire(), t_ns=self.t_ns, unlinked=self.unlinked
        )

    @staticmethod
    def from_wire(wire: station_pb2.Tick) -> Tick:
        return Tick(Header.from_wire(wire.header), wire.t_ns, tuple(wire.unlinked))
