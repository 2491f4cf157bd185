"""Moves of the incident frame, and of all coordinates in it."""

from __future__ import annotations

import math

import msgspec

from base_station.core.pins.pin_registry import reframe_pins
from base_station.core.state import StationState
from base_station.core.state.trail import TrailStep
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from shared.geo import Anchor, rotate, wrap_pi


def moved_to(anchor: Anchor, old: Anchor) -> RigidTransform2D:
    """Transform from the frame of the ``old`` anchor to the frame of this one.

    North is not parallel at two places, by degrees where an anchor was mistyped: the transform
    there and back again has to be the identity.
    """
    north_m, east_m, _ = anchor.to_incident_m(old.lat_deg, old.lon_deg, old.height_m)
    back_north_m, back_east_m, _ = old.to_incident_m(
        anchor.lat_deg, anchor.lon_deg, anchor.height_m
    )
    apart_m = 0.5 * (math.hypot(north_m, east_m) + math.hypot(back_north_m, back_east_m))
    turn_rad = old.rotation_rad - anchor.rotation_rad
    if apart_m > 1.0:  # nearer, and the paths give no direction
        there_rad = math.atan2(east_m, north_m)
        turn_rad = wrap_pi(there_rad + math.pi - math.atan2(back_east_m, back_north_m))
        north_m, east_m = rotate(apart_m, 0.0, there_rad)
    return RigidTransform2D(turn_rad, north_m, east_m, anchor.height_m - old.height_m)


def moved_by(anchor: Anchor, old: Anchor, taken_by: Anchor | None) -> RigidTransform2D:
    """Transform of fixes taken with the anchor ``taken_by``, composed directly through it: a chain
    over distant wrong anchors would turn north.
    """
    taken_by = taken_by or old
    return moved_to(old, taken_by).inverse().followed_by(moved_to(anchor, taken_by))


def reframe(state: StationState, site_id: str, move: RigidTransform2D) -> None:
    """Move paths, trails, pins and the learnt building of a site; fusers move by themselves."""
    site = state.sites[site_id]
    shift_m = (move.north_m, move.east_m)
    for history in state.paths_on(site_id).values():
        history.reframe(move.turn_rad, *shift_m, move.down_m)
    for unit in state.units_on(site_id):
        trails = unit.trails
        trails.shown = [_moved_step(step, move) for step in trails.shown]
        if trails.unpinned is not None:
            trails.unpinned = [_moved_step(step, move) for step in trails.unpinned]
    site.learnt_building = site.learnt_building.reframed(move.turn_rad, *shift_m)
    reframe_pins(site, move.turn_rad, *shift_m)
    site.learnt_floors.reframe(move.turn_rad, *shift_m, move.down_m)


def _moved_step(step: TrailStep, move: RigidTransform2D) -> TrailStep:
    north_m, east_m = move.apply(step.north_m, step.east_m)
    return msgspec.structs.replace(step, north_m=north_m, east_m=east_m)
