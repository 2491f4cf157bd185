"""Position of a wearer by the unit's tracker, in the unit's own frame."""

from __future__ import annotations

from functools import lru_cache

import msgspec

from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import position_pb2
from shared.messages.quantise import (
    HALF_TURN_CDEG,
    angle_std_known_to_cdeg,
    angle_std_to_cdeg,
    cdeg_to_heading,
    heading_to_cdeg,
    signed32,
    unsigned32,
    unsigned_known,
)
from shared.path_noise import PathNoise
from shared.quality import DEGRADED, GOOD, NOT_OF_STEPS, Quality, Reason


class MagneticNorth(msgspec.Struct, frozen=True, gc=False):
    """Magnetic north in a unit's frame, as estimated by its calibrated compass.

    What bends the field lasts, so many of these tell hardly more than one: not to be averaged.
    """

    heading_rad: float  # clockwise from the frame's north
    std_rad: float


class Position(msgspec.Struct, frozen=True, gc=False):
    """NED about the unit's start; the frame's north is the unit's own unless it has a compass."""

    header: Header
    north_m: float
    east_m: float
    down_m: float
    velocity_north_mps: float
    velocity_east_mps: float
    velocity_down_mps: float
    std_north_m: float
    std_east_m: float
    std_down_m: float
    correlation_ne: float  # -1..1, of the north and east errors
    heading_rad: float  # of travel, clockwise from the frame's north
    heading_std_rad: float
    distance_m: float  # walked since the start, horizontal
    pressure_pa: float | None
    stationary: bool
    quality: Quality
    reasons: Reason
    magnetic_north: MagneticNorth | None = None  # None: not known
    path_noise: PathNoise | None = None  # as the tracker models its path; None: not known

    @property
    def path_quality(self) -> Quality:
        """Quality of the last steps alone.

        The error that a long way has accumulated does not lower it: what ties the path to places
        has an error of its own.  Nor does a drift of the heading, as its deviation is stated.
        """
        if self.quality is GOOD or not self.reasons & NOT_OF_STEPS:
            return self.quality
        others = self.reasons & ~NOT_OF_STEPS
        if not others:
            return GOOD
        # Of what is against its steps only stances that are missing or wrong make a path lost.
        stances = Reason.NO_STANCE | Reason.INCONSISTENT | Reason.NOT_ON_FOOT
        return self.quality if others & stances else min(self.quality, DEGRADED)

    def to_wire(self) -> position_pb2.Position:
        north, noise = self.magnetic_north, self.path_noise or _UNKNOWN_NOISE
        return position_pb2.Position(
            header=self.header.to_wire(),
            north_mm=signed32(self.north_m, 1e3),
            east_mm=signed32(self.east_m, 1e3),
            down_mm=signed32(self.down_m, 1e3),
            velocity_north_mmps=signed32(self.velocity_north_mps, 1e3),
            velocity_east_mmps=signed32(self.velocity_east_mps, 1e3),
            velocity_down_mmps=signed32(self.velocity_down_mps, 1e3),
            std_north_mm=unsigned32(self.std_north_m, 1e3),
            std_east_mm=unsigned32(self.std_east_m, 1e3),
            std_down_mm=unsigned32(self.std_down_m, 1e3),
            correlation_ne_permille=signed32(self.correlation_ne, 1e3),
            heading_cdeg=heading_to_cdeg(self.heading_rad),
            heading_std_cdeg=angle_std_to_cdeg(self.heading_std_rad),
            distance_cm=unsigned32(self.distance_m, 1e2),
            pressure_dpa=0 if self.pressure_pa is None else unsigned32(self.pressure_pa, 10.0),
            stationary=self.stationary,
            quality=int(self.quality),  # type: ignore[arg-type]  # stubs want the generated enum
            reasons=int(self.reasons),
            magnetic_north_cdeg=0 if north is None else heading_to_cdeg(north.heading_rad),
            magnetic_north_std_cdeg=0 if north is None else angle_std_known_to_cdeg(north.std_rad),
            path_scale_std_permille=unsigned_known(noise.scale_std or 0.0, 1e3),
            path_place_std_mm_per_sqrt_m=unsigned_known(noise.place_std_m_per_sqrt_m or 0.0, 1e3),
            path_turn_std_mrad_per_sqrt_m=unsigned_known(noise.turn_std_rad_per_sqrt_m or 0.0, 1e3),
        )

    @staticmethod
    def from_wire(wire: position_pb2.Position) -> Position:
        return Position(  # by place, which takes two thirds of the time
            Header.from_wire(wire.header),
            wire.north_mm * 1e-3,
            wire.east_mm * 1e-3,
            wire.down_mm * 1e-3,
            wire.velocity_north_mmps * 1e-3,
            wire.velocity_east_mmps * 1e-3,
            wire.velocity_down_mmps * 1e-3,
            wire.std_north_mm * 1e-3,
            wire.std_east_mm * 1e-3,
            wire.std_down_mm * 1e-3,
            wire.correlation_ne_permille * 1e-3,
            cdeg_to_heading(wire.heading_cdeg),
            cdeg_to_heading(wire.heading_std_cdeg),
            wire.distance_cm * 1e-2,
            wire.pressure_dpa * 0.1 if wire.pressure_dpa else None,
            wire.stationary,
            known(Quality, wire.quality),
            _reasons(wire.reasons & _ALL_REASONS),
            _magnetic_north(wire),
            _path_noise(
                wire.path_scale_std_permille,
                wire.path_place_std_mm_per_sqrt_m,
                wire.path_turn_std_mrad_per_sqrt_m,
            ),
        )


def _magnetic_north(wire: position_pb2.Position) -> MagneticNorth | None:
    if not 0 < wire.magnetic_north_std_cdeg < HALF_TURN_CDEG:
        return None
    return MagneticNorth(
        heading_rad=cdeg_to_heading(wire.magnetic_north_cdeg),
        std_rad=cdeg_to_heading(wire.magnetic_north_std_cdeg),
    )


_UNKNOWN_NOISE = PathNoise()
_ALL_REASONS = int(sum(Reason))


@lru_cache(maxsize=512)
def _path_noise(scale_permille: int, place_mm: int, turn_mrad: int) -> PathNoise | None:
    """Path noise of wire values, of which 0 is not known; None where all are."""
    stated = [value * 1e-3 if value else None for value in (scale_permille, place_mm, turn_mrad)]
    return None if not any(stated) else PathNoise(*stated)


@lru_cache(maxsize=512)
def _reasons(bits: int) -> Reason:
    return Reason(bits)
