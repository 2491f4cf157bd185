"""What is known of one unit, said as an estimate: how sure, and in words how far to trust it."""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.kernels import Placed
from base_station.fusion.parameters import Parameters
from base_station.fusion.port import Estimate
from shared.quality import Quality


class Knowledge(msgspec.Struct, frozen=True):
    t_mono_ns: int
    placed: Placed
    height: tuple[float, float]  # down, variance
    own_heading_rad: float
    tracker: Quality  # as the unit says of its own path
    assumed: bool  # nothing ties the own frame to the incident frame
    since_gps_s: float | None


def estimate_of(kind: Parameters, known: Knowledge) -> Estimate:
    placed = known.placed
    quality, reason = _judge(kind, known, math.hypot(placed.std_north_m, placed.std_east_m))
    return Estimate(
        t_mono_ns=known.t_mono_ns,
        north_m=placed.north_m,
        east_m=placed.east_m,
        down_m=known.height[0],
        std_north_m=placed.std_north_m,
        std_east_m=placed.std_east_m,
        std_down_m=math.sqrt(known.height[1]),
        correlation_ne=placed.correlation_ne,
        heading_rad=(placed.turn_rad + known.own_heading_rad) % (2.0 * math.pi),
        heading_std_rad=placed.turn_std_rad,
        quality=quality,
        quality_reason=reason,
        since_gps_s=known.since_gps_s,
    )


def _judge(kind: Parameters, known: Knowledge, std_m: float) -> tuple[Quality, str]:
    """Quality and the first reason against it."""
    if known.tracker is Quality.LOST:
        return Quality.LOST, "the unit's tracker is lost"
    if known.assumed:
        return Quality.DEGRADED, "start not known: shown about the unit's own start"
    if std_m > kind.lost_m:
        return Quality.LOST, f"within {2.0 * std_m:.0f} m"
    if known.placed.turn_std_rad > kind.aligned_rad:
        return Quality.DEGRADED, "heading not known yet"
    if std_m > kind.unsure_m:
        return Quality.DEGRADED, f"within {2.0 * std_m:.0f} m"
    unsure = known.tracker is Quality.DEGRADED
    return (Quality.DEGRADED, "the unit's tracker is unsure") if unsure else (Quality.GOOD, "")
