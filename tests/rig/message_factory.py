"""Messages of units and the station, filled in plausibly; for benchmarks and tests.

Keyword arguments replace fields.
"""

from __future__ import annotations

import msgspec

from shared.clock import NS_PER_S
from shared.messages import (
    Activity,
    FixType,
    FusedPosition,
    GpsFix,
    Header,
    Position,
    Status,
    UnitDescription,
)
from shared.quality import Quality, Reason


def mono_ns(t_s: float) -> int:
    """On the clock of a unit that ran for a while when what is looked at began."""
    return round((1000.0 + t_s) * NS_PER_S)


def position(header: Header, /, **changes: object) -> Position:
    """At its start, and sure of it."""
    usual = Position(
        header=header,
        north_m=0.0,
        east_m=0.0,
        down_m=0.0,
        velocity_north_mps=0.0,
        velocity_east_mps=0.0,
        velocity_down_mps=0.0,
        std_north_m=0.1,
        std_east_m=0.1,
        std_down_m=0.1,
        correlation_ne=0.0,
        heading_rad=0.0,
        heading_std_rad=0.1,
        distance_m=0.0,
        pressure_pa=None,
        stationary=False,
        quality=Quality.GOOD,
        reasons=Reason.NONE,
    )
    return msgspec.structs.replace(usual, **changes)


def fused(header: Header, unit_id: str, /, **changes: object) -> FusedPosition:
    """At the anchor, and sure of it."""
    usual = FusedPosition(
        header=header,
        unit_id=unit_id,
        t_meas_ns=header.t_utc_ns,
        north_m=0.0,
        east_m=0.0,
        down_m=0.0,
        std_north_m=0.1,
        std_east_m=0.1,
        std_down_m=0.1,
        correlation_ne=0.0,
        heading_rad=0.0,
        heading_std_rad=0.1,
        floor=None,
        quality=Quality.GOOD,
        quality_reason="",
        fuser="gps-inertial",
        since_gps_s=None,
    )
    return msgspec.structs.replace(usual, **changes)


def gps_fix(header: Header, lat_deg: float, lon_deg: float, /, **changes: object) -> GpsFix:
    """Fix of a receiver at rest under an open sky."""
    usual = GpsFix(
        header=header,
        fix_type=FixType.THREE_D,
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        height_m=50.0,
        horizontal_std_m=3.0,
        vertical_std_m=6.0,
        satellites=9,
        speed_mps=0.0,
        course_rad=0.0,
    )
    return msgspec.structs.replace(usual, **changes)


def status(header: Header, /, **changes: object) -> Status:
    """Status of a walking wearer without problems."""
    usual = Status(
        header=header,
        activity=Activity.WALKING,
        motionless_s=0.0,
        battery=0.8,
        mayday=False,
        steps=10,
        cadence_hz=1.0,
        floors_climbed=0,
        tracker_rows_dropped=0,
        journal_pending=0,
    )
    return msgspec.structs.replace(usual, **changes)


def description(header: Header, /, **changes: object) -> UnitDescription:
    """Description of a unit with an inertial sensor only, which tracks itself."""
    usual = UnitDescription(
        header=header,
        software_version="1",
        source="test",
        sensor_name="sensor",
        rate_hz=100.0,
        accel_full_scale_mps2=None,
        gyro_full_scale_radps=None,
        tracker="eskf",
        calibration="",
        has_magnetometer=False,
        has_barometer=False,
        has_gps=False,
    )
    return msgspec.structs.replace(usual, **changes)
