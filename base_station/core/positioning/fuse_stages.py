"""Stages of a position on its way into the estimate (``positioning.FUSE``)."""

from __future__ import annotations

import math
from typing import Any

import msgspec

from base_station.core.positioning.building_entry import is_outside
from base_station.core.positioning.clocks import placed_ns
from base_station.core.state import SiteState, StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.fusion.horizontal.compass import compass_heading
from base_station.fusion.interface import CompassHeading, Fuser
from base_station.fusion.odometry.path_history import PathHistory
from base_station.site.learnt_floors import GROUND_RANGE_M, Landing
from shared.clock import NS_PER_S
from shared.messages import Position

_LATER: Any = None  # set by a stage, and read by none before it


class PositionUpdate(msgspec.Struct, gc=False):
    """Position of a unit's own path; a stage reads the fields that earlier stages have set."""

    state: StationState
    site: SiteState
    unit: UnitState
    position: Position
    history: PathHistory
    fusers: tuple[Fuser, ...]  # the first one ignores pins
    has_plan: bool  # its storeys are known to the fusers
    boot: BootState = _LATER  # its clock dates the position
    t_ns: int = 0  # station time
    outage_s: float = math.inf  # since the last position of the path
    is_rejected: bool = False  # it does not join the path
    is_outside: bool = False  # the barometer is in outside air
    begins_path: bool = False


def place_in_time(update: PositionUpdate) -> None:
    """Convert the time to station time."""
    boot = update.boot = update.unit.path_boot
    t_ns = update.t_ns = placed_ns(boot, update.position.header.t_mono_ns, update.state.t_ns)
    end_ns = update.history.end_ns
    if end_ns is not None:
        update.outage_s = (t_ns - end_ns) / NS_PER_S


def predict(update: PositionUpdate) -> None:
    """Predict the state of each fuser along the own path."""
    fuser, *pinned = update.fusers
    reason = fuser.predict(update.position, update.outage_s)
    if reason:
        update.unit.count_rejected(reason)
        update.is_rejected = True
    for one in pinned:
        one.predict(update.position, update.outage_s)


def update_height_and_heading(update: PositionUpdate) -> None:
    """Update with barometer and compass, where the unit has them."""
    site, unit, position = update.site, update.unit, update.position
    update.is_outside = outside = is_outside(site.placed_plan, update.history)
    air = site.barometers.update(unit.unit_id, update.t_ns, position, is_outside=outside)
    heading = _compass_heading(update.state.t_ns, site, position)
    for fuser in update.fusers:
        if air is not None:
            fuser.update_barometer(air)
        if heading is not None:
            fuser.update_heading(heading)


def match_building(update: PositionUpdate) -> None:
    """Match the path with the building that all units have walked; only a path without pins adds
    to that.
    """
    site = update.site
    fuser, *pinned = update.fusers
    site.learnt_building = fuser.match_building(site.learnt_building)
    for one in pinned:
        one.match_building(site.learnt_building)


def extend_path(update: PositionUpdate) -> None:
    """Append to the path that is solved again when pins change."""
    update.begins_path = update.history.append(update.position, update.t_ns, update.is_rejected)


def learn_storey(update: PositionUpdate) -> None:
    """Learn a storey, or its height, where the wearer walks on the level."""
    site, unit = update.site, update.unit
    if not site.learnt_floors.follow(update.position, unit.unit_id):
        return
    estimate = update.fusers[0].estimate()
    if estimate is None:
        return
    place = estimate.north_m, estimate.east_m
    start = update.history.start.position
    site.learnt_floors.add_landing(
        Landing(update.t_ns, unit.unit_id, *place, estimate.down_m, estimate.std_down_m),
        is_outside=update.is_outside,
        began_on_ground=start is None or abs(start.down_m) < GROUND_RANGE_M,
    )
    if not update.has_plan:  # else the fuser knows the plan's storeys, and when it is inside
        storeys = [one for one in site.storeys_at(*place) if one.seen]
        for fuser in update.fusers:
            fuser.constrain_to_floors(storeys)


def _compass_heading(t_ns: int, site: SiteState, position: Position) -> CompassHeading | None:
    """Heading of the own frame by the compass; None without a compass or an anchor."""
    if position.magnetic_north is None or site.anchor is None:
        return None
    return compass_heading(position.magnetic_north, site.anchor, t_ns)
