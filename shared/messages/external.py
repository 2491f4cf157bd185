"""People and markers of other teams, as another system sent them."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import external_pb2


class ExternalKind(IntEnum):
    UNKNOWN = 0
    PERSON = 1  # or vehicle: whatever moves
    MARKER = 2  # a marked place
    EMERGENCY = 3


class ExternalMarker(msgspec.Struct, frozen=True):
    marker_id: str  # the forwarder's name, and the id in the other system
    source: str  # name of the forwarder
    name: str
    kind: ExternalKind
    type: str  # as the other system has it
    remarks: str
    lat_deg: float
    lon_deg: float
    radius_m: float  # of the region in which it is; 0: unknown
    t_ns: int  # station time to which the place belongs
    stale_ns: int  # from then on it is old

    def to_wire(self) -> external_pb2.ExternalMarkers.Marker:
        return external_pb2.ExternalMarkers.Marker(
            marker_id=self.marker_id,
            source=self.source,
            name=self.name,
            kind=int(self.kind),  # type: ignore[arg-type]  # stubs want the generated enum
            type=self.type,
            remarks=self.remarks,
            lat_deg=self.lat_deg,
            lon_deg=self.lon_deg,
            radius_m=self.radius_m,
            t_ns=self.t_ns,
            stale_ns=self.stale_ns,
        )

    @staticmethod
    def from_wire(wire: external_pb2.ExternalMarkers.Marker) -> ExternalMarker:
        return ExternalMarker(
            marker_id=wire.marker_id,
            source=wire.source,
            name=wire.name,
            kind=known(ExternalKind, wire.kind),
            type=wire.type,
            remarks=wire.remarks,
            lat_deg=wire.lat_deg,
            lon_deg=wire.lon_deg,
            radius_m=wire.radius_m,
            t_ns=wire.t_ns,
            stale_ns=wire.stale_ns,
        )


class ExternalMarkers(msgspec.Struct, frozen=True):
    """Markers that changed, and ids of those that are gone."""

    header: Header  # the station's
    markers: tuple[ExternalMarker, ...] = ()
    removed: tuple[str, ...] = ()

    def to_wire(self) -> external_pb2.ExternalMarkers:
        return external_pb2.ExternalMarkers(
            header=self.header.to_wire(),
            markers=[one.to_wire() for one in self.markers],
            removed=self.removed,
        )

    @staticmethod
    def from_wire(wire: external_pb2.ExternalMarkers) -> ExternalMarkers:
        return ExternalMarkers(
            header=Header.from_wire(wire.header),
            markers=tuple(map(ExternalMarker.from_wire, wire.markers)),
            removed=tuple(wire.removed),
        )
