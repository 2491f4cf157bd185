"""The way that the console draws behind a unit: thinned, and bounded in length."""

from __future__ import annotations

from bisect import bisect_left

import msgspec

from shared.clock import NS_PER_S
from shared.messages import FusedPosition

TRAIL_POINTS = 900  # a unit's trail in the console; the log has all of it
TRAIL_STEP_M = 0.5
TRAIL_STEP_NS = NS_PER_S
TRAIL_REST_NS = 15 * NS_PER_S  # somebody standing still leaves a point this often


class TrailStep(msgspec.Struct, frozen=True, array_like=True):
    t_ns: int
    north_m: float
    east_m: float
    floor: int | None


def extend_trail(trail: list[TrailStep], fused: FusedPosition) -> bool:
    """Add a point where the wearer moved, at most one a second; True where one was added."""
    if trail:
        last = trail[-1]
        age_ns = fused.t_meas_ns - last.t_ns
        if age_ns < TRAIL_STEP_NS:
            return False
        moved_m2 = (fused.north_m - last.north_m) ** 2 + (fused.east_m - last.east_m) ** 2
        moved = moved_m2 >= TRAIL_STEP_M**2 or fused.floor != last.floor
        if not moved and age_ns < TRAIL_REST_NS:
            return False
    trail.append(TrailStep(fused.t_meas_ns, fused.north_m, fused.east_m, fused.floor))
    if len(trail) > TRAIL_POINTS:
        del trail[0]
    return True


def fill_trail(trail: list[TrailStep], fused: FusedPosition) -> bool:
    """Put a point that came late in its place, where none is near in time."""
    place = bisect_left(trail, fused.t_meas_ns, key=lambda step: step.t_ns)
    near = trail[max(place - 1, 0) : place + 1]
    if len(trail) >= TRAIL_POINTS and place == 0:
        return False
    if any(abs(step.t_ns - fused.t_meas_ns) < TRAIL_STEP_NS for step in near):
        return False
    trail.insert(place, TrailStep(fused.t_meas_ns, fused.north_m, fused.east_m, fused.floor))
    del trail[:-TRAIL_POINTS]
    return True
