"""Entry into the building: members inside, and barometers in outside air."""

from __future__ import annotations

from base_station.core.state import StationState, UnitState
from base_station.fusion.odometry.path_history import PathHistory
from base_station.site.plan import Plan

OUTSIDE_M = 3.0  # from the outer walls: there the pressure is that of the weather
OUTSIDE_FIX_S = 5.0  # where no plan is known, as long after a fix
WORK_BEGINS_M = 5.0  # walked since the start: taken as inside, where there is no plan


def is_outside(plan: Plan | None, history: PathHistory) -> bool:
    """True where a unit's barometer is in outside air. Estimated without pins, so that a pin does
    not change the state that is kept without pins.
    """
    shown_m = history.shown_m
    if shown_m is None:
        return False
    if plan is not None and plan.outlines:
        return plan.depth_m(*shown_m) < -OUTSIDE_M
    since_gps_s = history.latest.since_gps_s
    return since_gps_s is not None and since_gps_s < OUTSIDE_FIX_S


def note_inside(state: StationState, unit: UnitState) -> None:
    """Note the time since which the wearer is in the building; without an outline, since work
    began.
    """
    place = unit.place
    fused = place.fused
    if fused is None:
        return
    plan = state.sites[unit.site_id].placed_plan
    if plan is not None and plan.outlines:
        was_inside = place.inside_since_ns is not None
        is_inside = plan.is_inside(fused.north_m, fused.east_m, was_inside)
    else:
        at_work = state.open_incident_of(unit) is not None
        walked_m = unit.position.distance_m if unit.position else 0.0
        is_inside = at_work and (place.inside_since_ns is not None or walked_m > WORK_BEGINS_M)
    if not is_inside:
        place.inside_since_ns = None
    elif place.inside_since_ns is None:
        place.inside_since_ns = state.t_ns
