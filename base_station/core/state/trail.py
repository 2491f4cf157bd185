"""Trail that the console draws behind a unit: complete from the beginning of the incident, and
bounded in length.

Its older part is thinned by Douglas and Peucker (1973) and stays within a stated distance of the
original.  The last minutes, which are drawn of every unit, stay point by point.
"""

from __future__ import annotations

from bisect import bisect_left
from itertools import pairwise

import msgspec
import numpy as np

from base_station.site.simplified_line import corners
from shared.clock import NS_PER_S
from shared.messages import FusedPosition

TRAIL_POINTS = 900  # points of a trail in the console, at most; the log has all of them
TRAIL_STEP_M = 0.5
TRAIL_STEP_NS = NS_PER_S
TRAIL_REST_NS = 15 * NS_PER_S  # a wearer at rest leaves a point this often
TRAIL_GAP_NS = 20 * NS_PER_S  # after a longer gap the way between is unknown
TOLERANCE_M = 0.5  # of thinning, at first; doubled while too many points are left
RECENT_POINTS = 300  # five minutes of walking
OLDER_POINTS = 500  # at most, of all that was before
_DOUBLINGS = 10  # 512 m: beyond that only floors and gaps are kept


class TrailStep(msgspec.Struct, frozen=True, array_like=True, gc=False):
    t_ns: int
    north_m: float
    east_m: float
    floor: int | None
    after_gap: bool = False  # the way from the step before is unknown


def extend_trail(trail: list[TrailStep], fused: FusedPosition) -> bool:
    """Add a point where the wearer moved, at most one a second; True where one was added."""
    after_gap = False
    if trail:
        last = trail[-1]
        age_ns = fused.t_meas_ns - last.t_ns
        if age_ns < TRAIL_STEP_NS:
            return False
        moved_m2 = (fused.north_m - last.north_m) ** 2 + (fused.east_m - last.east_m) ** 2
        moved = moved_m2 >= TRAIL_STEP_M**2 or fused.floor != last.floor
        if not moved and age_ns < TRAIL_REST_NS:
            return False
        after_gap = age_ns > TRAIL_GAP_NS
    step = TrailStep(fused.t_meas_ns, fused.north_m, fused.east_m, fused.floor, after_gap)
    trail.append(step)
    bound(trail)
    return True


def insert_into_trail(trail: list[TrailStep], fused: FusedPosition) -> bool:
    """Insert a late point by its time, where none is near in time."""
    place = bisect_left(trail, fused.t_meas_ns, key=lambda step: step.t_ns)
    before, after = trail[max(place - 1, 0) : place], trail[place : place + 1]
    if any(abs(step.t_ns - fused.t_meas_ns) < TRAIL_STEP_NS for step in before + after):
        return False
    after_gap = False
    if before and after and not after[0].after_gap:
        if after[0].t_ns - before[0].t_ns > TRAIL_GAP_NS:
            return False  # the way between is known, and was thinned
    else:
        after_gap = any(fused.t_meas_ns - step.t_ns > TRAIL_GAP_NS for step in before)
        trail[place : place + 1] = [
            msgspec.structs.replace(step, after_gap=step.t_ns - fused.t_meas_ns > TRAIL_GAP_NS)
            for step in after
        ]
    step = TrailStep(fused.t_meas_ns, fused.north_m, fused.east_m, fused.floor, after_gap)
    trail.insert(place, step)
    bound(trail)
    return True


def bound(trail: list[TrailStep]) -> None:
    """Thin the trail where it is too long."""
    if len(trail) > TRAIL_POINTS:
        trail[:] = _thinned_trail(trail)


def _thinned_trail(trail: list[TrailStep]) -> list[TrailStep]:
    """At most ``RECENT_POINTS`` and ``OLDER_POINTS``.  Changes of the floor and ends of gaps stay;
    if these alone are too many, the oldest are dropped.
    """
    older, recent = trail[:-RECENT_POINTS], trail[-RECENT_POINTS:]
    tolerance_m = TOLERANCE_M
    for _ in range(_DOUBLINGS):
        older = _simplified_trail(older, tolerance_m)
        if len(older) <= OLDER_POINTS:
            break
        tolerance_m *= 2.0
    return older[-OLDER_POINTS:] + recent


def _simplified_trail(steps: list[TrailStep], tolerance_m: float) -> list[TrailStep]:
    places_m = np.array([(step.north_m, step.east_m) for step in steps])
    begins = [
        number
        for number, (before, step) in enumerate(pairwise(steps), 1)
        if step.after_gap or step.floor != before.floor
    ]
    kept = np.zeros(len(steps), dtype=np.bool_)
    for begin, end in pairwise([0, *begins, len(steps)]):
        kept[begin:end] = corners(places_m[begin:end], tolerance_m)
    return [step for step, keep in zip(steps, kept.tolist(), strict=True) if keep]
