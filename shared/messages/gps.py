"""A satellite fix as the receiver gave it."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import gps_pb2
from shared.messages.quantise import cdeg_to_heading, heading_to_cdeg, signed32, unsigned32


class FixType(IntEnum):
    UNKNOWN = 0
    NONE = 1
    TWO_D = 2
    THREE_D = 3


class GpsFix(msgspec.Struct, frozen=True):
    """WGS-84; ``header`` carries the time at which the fix is valid."""

    header: Header
    fix_type: FixType
    lat_deg: float
    lon_deg: float
    height_m: float  # above the ellipsoid
    horizontal_std_m: float | None
    vertical_std_m: float | None
    satellites: int
    speed_mps: float
    course_rad: float

    def to_wire(self) -> gps_pb2.GpsFix:
        return gps_pb2.GpsFix(
            header=self.header.to_wire(),
            fix_type=int(self.fix_type),  # type: ignore[arg-type]  # stubs want the generated enum
            lat_e9_deg=round(self.lat_deg * 1e9),
            lon_e9_deg=round(self.lon_deg * 1e9),
            height_mm=signed32(self.height_m, 1e3),
            horizontal_std_mm=unsigned32(self.horizontal_std_m or 0.0, 1e3),
            vertical_std_mm=unsigned32(self.vertical_std_m or 0.0, 1e3),
            satellites=self.satellites,
            speed_mmps=unsigned32(self.speed_mps, 1e3),
            course_cdeg=heading_to_cdeg(self.course_rad),
        )

    @staticmethod
    def from_wire(wire: gps_pb2.GpsFix) -> GpsFix:
        return GpsFix(
            header=Header.from_wire(wire.header),
            fix_type=known(FixType, wire.fix_type),
            lat_deg=wire.lat_e9_deg * 1e-9,
            lon_deg=wire.lon_e9_deg * 1e-9,
            height_m=wire.height_mm * 1e-3,
            horizontal_std_m=wire.horizontal_std_mm * 1e-3 or None,
            vertical_std_m=wire.vertical_std_mm * 1e-3 or None,
            satellites=wire.satellites,
            speed_mps=wire.speed_mmps * 1e-3,
            course_rad=cdeg_to_heading(wire.course_cdeg),
        )
