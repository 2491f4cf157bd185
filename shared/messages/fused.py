"""Fused position of a unit's wearer, in the incident frame."""

from __future__ import annotations

import msgspec

from shared.coded_text import NO_CODE, TextCode
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import fused_pb2
from shared.messages.quantise import (
    angle_std_to_cdeg,
    cdeg_to_heading,
    heading_to_cdeg,
    signed32,
    unsigned32,
)
from shared.messages.text_code import get_text_code, put_text_code
from shared.quality import Quality


class FusedPosition(msgspec.Struct, frozen=True, gc=False):
    """NED metres about the site anchor."""

    header: Header  # the station's
    unit_id: str
    t_meas_ns: int  # station time to which the position belongs
    north_m: float
    east_m: float
    down_m: float
    std_north_m: float
    std_east_m: float
    std_down_m: float
    correlation_ne: float
    heading_rad: float
    heading_std_rad: float  # pi and above: unknown
    floor: int | None
    quality: Quality
    quality_reason: str
    fuser: str
    since_gps_s: float | None  # None: no fix ever
    floor_probability: float | None = None  # of the floor, where one is known
    quality_code: TextCode = NO_CODE  # of ``quality_reason``; none of an earlier version

    def to_wire(self) -> fused_pb2.FusedPosition:
        wire = fused_pb2.FusedPosition()
        self.header.fill(wire.header)
        wire.unit_id, wire.t_meas_ns = self.unit_id, self.t_meas_ns
        wire.north_mm = signed32(self.north_m, 1e3)
        wire.east_mm = signed32(self.east_m, 1e3)
        wire.down_mm = signed32(self.down_m, 1e3)
        wire.std_north_mm = unsigned32(self.std_north_m, 1e3)
        wire.std_east_mm = unsigned32(self.std_east_m, 1e3)
        wire.std_down_mm = unsigned32(self.std_down_m, 1e3)
        wire.correlation_ne_permille = signed32(self.correlation_ne, 1e3)
        wire.heading_cdeg = heading_to_cdeg(self.heading_rad)
        wire.heading_std_cdeg = angle_std_to_cdeg(self.heading_std_rad)
        wire.quality = int(self.quality)  # type: ignore[assignment]  # stubs want the generated enum
        wire.quality_reason, wire.fuser = self.quality_reason, self.fuser
        if self.floor is not None:
            wire.floor, wire.floor_known = self.floor, True
        if self.since_gps_s is not None:
            wire.seconds_since_gps, wire.gps_ever = unsigned32(self.since_gps_s, 1.0), True
        if self.floor_probability is not None:
            wire.floor_permille = unsigned32(self.floor_probability, 1e3)
        if self.quality_code.code:
            put_text_code(wire.quality_code, self.quality_code)
        return wire

    @staticmethod
    def from_wire(wire: fused_pb2.FusedPosition) -> FusedPosition:
        return FusedPosition(
            header=Header.from_wire(wire.header),
            unit_id=wire.unit_id,
            t_meas_ns=wire.t_meas_ns,
            north_m=wire.north_mm * 1e-3,
            east_m=wire.east_mm * 1e-3,
            down_m=wire.down_mm * 1e-3,
            std_north_m=wire.std_north_mm * 1e-3,
            std_east_m=wire.std_east_mm * 1e-3,
            std_down_m=wire.std_down_mm * 1e-3,
            correlation_ne=wire.correlation_ne_permille * 1e-3,
            heading_rad=cdeg_to_heading(wire.heading_cdeg),
            heading_std_rad=cdeg_to_heading(wire.heading_std_cdeg),
            floor=wire.floor if wire.floor_known else None,
            quality=known(Quality, wire.quality),
            quality_reason=wire.quality_reason,
            fuser=wire.fuser,
            since_gps_s=float(wire.seconds_since_gps) if wire.gps_ever else None,
            floor_probability=wire.floor_permille * 1e-3 if wire.floor_permille else None,
            quality_code=get_text_code(wire.quality_code),
        )
