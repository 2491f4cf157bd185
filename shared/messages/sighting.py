"""A unit was near a beacon, a tag or another unit."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import sighting_pb2
from shared.messages.quantise import unsigned32


class SightingKind(IntEnum):
    UNKNOWN = 0
    BEACON = 1
    TAG = 2
    UNIT = 3


class Sighting(msgspec.Struct, frozen=True):
    """``header`` carries the time at which it was seen."""

    header: Header
    kind: SightingKind
    seen_id: str
    range_m: float | None = None
    range_std_m: float | None = None

    def to_wire(self) -> sighting_pb2.Sighting:
        return sighting_pb2.Sighting(
            header=self.header.to_wire(),
            kind=int(self.kind),  # type: ignore[arg-type]  # stubs want the generated enum
            seen_id=self.seen_id,
            range_mm=unsigned32(self.range_m or 0.0, 1e3),
            range_std_mm=unsigned32(self.range_std_m or 0.0, 1e3),
        )

    @staticmethod
    def from_wire(wire: sighting_pb2.Sighting) -> Sighting:
        return Sighting(
            header=Header.from_wire(wire.header),
            kind=known(SightingKind, wire.kind),
            seen_id=wire.seen_id,
            range_m=wire.range_mm * 1e-3 or None,
            range_std_m=wire.range_std_mm * 1e-3 or None,
        )
