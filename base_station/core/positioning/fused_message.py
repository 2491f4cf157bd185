"""Fused position message from an estimate, with its floor."""

from __future__ import annotations

import math

from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.fusion.interface import Estimate
from base_station.site.storeys import floor_at, floor_probability
from shared.coded_text import code_of_text, coded
from shared.messages import FusedPosition, Header
from shared.quality import DEGRADED, LOST

ASSUMED_STD_M = 6.0  # a unit may have been switched on upstairs


def fused_message(
    state: StationState,
    unit: UnitState,
    boot: BootState,
    estimate: Estimate,
    fuser: str,
    held: int | None,
    header: Header,
) -> FusedPosition:
    """``boot``: in whose clock the estimate's time is; ``held``: the floor it was on, where that is
    known.
    """
    site = state.sites[unit.site_id]
    storeys = site.storeys_at(estimate.north_m, estimate.east_m)
    floor = floor_at(storeys, estimate.down_m, held)
    std_down_m = estimate.std_down_m
    if estimate.height_assumed:
        std_down_m = math.hypot(std_down_m, ASSUMED_STD_M)
    sure = None
    if floor is not None:
        sure = floor_probability(storeys, floor, estimate.down_m, std_down_m)
    quality, reason = estimate.quality, estimate.quality_reason
    if site.plan is not site.placed_plan and quality is not LOST:
        quality, reason = DEGRADED, coded("doubt-plan", "the plan is not placed")
    return FusedPosition(  # by place: every position comes through here
        header,
        unit.unit_id,
        min(boot.station_ns(estimate.t_mono_ns), header.t_utc_ns),
        estimate.north_m,
        estimate.east_m,
        estimate.down_m,
        estimate.std_north_m,
        estimate.std_east_m,
        std_down_m,
        estimate.correlation_ne,
        estimate.heading_rad,
        estimate.heading_std_rad,
        floor,
        quality,
        str(reason),
        fuser,
        estimate.since_gps_s,
        sure,
        code_of_text(reason),
    )
