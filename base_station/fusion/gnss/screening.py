"""Satellite fixes that cannot be true are turned away before any filter sees them."""

from __future__ import annotations

import math

from base_station.fusion.gnss.fix_faults import FIX_FAULTS
from base_station.fusion.interface import MAX_FIX_DISTANCE_M, FixVerdict, PlaceFix
from shared.geo import Anchor
from shared.messages import FixType, GpsFix

STD_FLOOR_M = 1.27  # each axis: 1.5 m CEP of data sheets; a better claim is too optimistic
STD_UNSTATED_M = 10.0
STD_ABSURD_M = 100.0
DEEPEST_M, HIGHEST_M = -1_000.0, 10_000.0  # above the ellipsoid, of any place on the ground
ANCHOR_STD_M = 8.0  # of the worst fix that may place the site


def screen_fix(fix: GpsFix) -> FixVerdict:
    """Verdict on a fix by itself, independent of the site."""
    if fix.fix_type not in {FixType.TWO_D, FixType.THREE_D}:
        return FixVerdict(False, "the receiver has no fix")
    std_m = fix.horizontal_std_m
    defects = {
        "not-a-number": not all(
            math.isfinite(value) for value in (fix.lat_deg, fix.lon_deg, fix.height_m)
        ),
        "not-on-earth": abs(fix.lat_deg) > 90.0 or abs(fix.lon_deg) > 180.0,
        "zero": abs(fix.lat_deg) < 1e-6 and abs(fix.lon_deg) < 1e-6,
        "height": fix.fix_type is FixType.THREE_D and not DEEPEST_M <= fix.height_m <= HIGHEST_M,
        "accuracy": std_m is not None and not 0.0 < std_m <= STD_ABSURD_M,
    }
    reason = next((FIX_FAULTS[code] for code, holds in defects.items() if holds), "")
    return FixVerdict(not reason, reason, faulty=bool(reason))


def may_anchor(fix: GpsFix) -> bool:
    """True of a screened fix good enough to set the anchor."""
    std_m = fix.horizontal_std_m
    return fix.fix_type is FixType.THREE_D and std_m is not None and std_m <= ANCHOR_STD_M


def in_incident_frame(fix: GpsFix, anchor: Anchor) -> PlaceFix | FixVerdict:
    """The screened fix where the anchor puts it, or why it cannot be there."""
    north_m, east_m, down_m = anchor.to_incident_m(fix.lat_deg, fix.lon_deg, fix.height_m)
    if math.hypot(north_m, east_m) > MAX_FIX_DISTANCE_M:
        return FixVerdict(False, FIX_FAULTS["far-away"], faulty=True)
    horizontal_std_m = max(fix.horizontal_std_m or STD_UNSTATED_M, STD_FLOOR_M)
    has_height = fix.fix_type is FixType.THREE_D
    return PlaceFix(
        t_mono_ns=fix.header.t_mono_ns,
        north_m=north_m,
        east_m=east_m,
        down_m=down_m,
        horizontal_std_m=horizontal_std_m,
        vertical_std_m=(fix.vertical_std_m or 2.0 * horizontal_std_m) if has_height else None,
    )
