"""What is known of one unit, said as an estimate: how sure, and in words how far to trust it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.parameters import Parameters
from base_station.fusion.port import Estimate
from shared.quality import Quality

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Knowledge:
    t_mono_ns: int
    place: tuple[Floats, Floats]  # north and east (2,), covariance (2, 2)
    height: tuple[float, float]  # down, variance
    turn: tuple[float, float]  # of the own frame, standard deviation
    own_heading_rad: float
    tracker: Quality  # as the unit says of its own path
    assumed: bool  # nothing ties the own frame to the incident frame
    since_gps_s: float | None


def estimate_of(kind: Parameters, known: Knowledge) -> Estimate:
    place_m, variances = known.place
    (var_north_m2, var_ne_m2), (_, var_east_m2) = variances.tolist()
    std_north_m, std_east_m = math.sqrt(var_north_m2), math.sqrt(var_east_m2)
    product = std_north_m * std_east_m
    turn_rad, turn_std_rad = known.turn
    quality, reason = _judge(kind, known, math.hypot(std_north_m, std_east_m))
    return Estimate(
        t_mono_ns=known.t_mono_ns,
        north_m=float(place_m[0]),
        east_m=float(place_m[1]),
        down_m=known.height[0],
        std_north_m=std_north_m,
        std_east_m=std_east_m,
        std_down_m=math.sqrt(known.height[1]),
        correlation_ne=var_ne_m2 / product if product > 0.0 else 0.0,
        heading_rad=(turn_rad + known.own_heading_rad) % (2.0 * math.pi),
        heading_std_rad=turn_std_rad,
        quality=quality,
        quality_reason=reason,
        since_gps_s=known.since_gps_s,
    )


def _judge(kind: Parameters, known: Knowledge, std_m: float) -> tuple[Quality, str]:
    """Quality and the first reason against it."""
    within = f"within {2.0 * std_m:.0f} m"
    causes = (
        (known.tracker is Quality.LOST, Quality.LOST, "the unit's tracker is lost"),
        (known.assumed, Quality.DEGRADED, "start not known: shown about the unit's own start"),
        (std_m > kind.lost_m, Quality.LOST, within),
        (known.turn[1] > kind.aligned_rad, Quality.DEGRADED, "heading not known yet"),
        (std_m > kind.unsure_m, Quality.DEGRADED, within),
        (known.tracker is Quality.DEGRADED, Quality.DEGRADED, "the unit's tracker is unsure"),
    )
    return next(((quality, why) for holds, quality, why in causes if holds), (Quality.GOOD, ""))
