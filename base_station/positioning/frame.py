"""The incident frame moves: all that stands in it moves along."""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.path.frame_shift import FrameShift
from base_station.live_state import StationState
from base_station.pins.book import reframe_pins
from base_station.units.trail import TrailStep
from shared.geo import Anchor, rotate, wrap_pi


def moved_to(anchor: Anchor, old: Anchor) -> FrameShift:
    """How the frame of the ``old`` anchor lies in that of this one.

    North is not parallel at two places, by degrees where one was typed wrong: what is moved there
    and back again has to be where it was.
    """
    north_m, east_m, _ = anchor.to_incident_m(old.lat_deg, old.lon_deg, old.height_m)
    back_north_m, back_east_m, _ = old.to_incident_m(
        anchor.lat_deg, anchor.lon_deg, anchor.height_m
    )
    apart_m = 0.5 * (math.hypot(north_m, east_m) + math.hypot(back_north_m, back_east_m))
    turn_rad = old.rotation_rad - anchor.rotation_rad
    if apart_m > 1.0:  # nearer, and the ways tell no direction
        there_rad = math.atan2(east_m, north_m)
        turn_rad = wrap_pi(there_rad + math.pi - math.atan2(back_east_m, back_north_m))
        north_m, east_m = rotate(apart_m, 0.0, there_rad)
    return FrameShift(turn_rad, north_m, east_m, anchor.height_m - old.height_m)


def moved_by(anchor: Anchor, old: Anchor, taken_by: Anchor | None) -> FrameShift:
    """The same of what was taken when the anchor was ``taken_by``: led round by wrong ones that are
    far away, north would come back turned.
    """
    taken_by = taken_by or old
    return moved_to(old, taken_by).undone().and_then(moved_to(anchor, taken_by))


def reframe(state: StationState, move: FrameShift) -> None:
    """Paths, trails, pins and what was learnt; the fusers move by themselves."""
    shift_m = (move.north_m, move.east_m)
    for history in state.paths.values():
        history.reframe(move.turn_rad, *shift_m, move.down_m)
    for unit in state.units.values():
        unit.trail = [_moved(step, move) for step in unit.trail]
        if unit.plain_trail is not None:
            unit.plain_trail = [_moved(step, move) for step in unit.plain_trail]
    state.learnt_building = state.learnt_building.reframed(move.turn_rad, *shift_m)
    reframe_pins(state, move.turn_rad, *shift_m)
    state.learnt_floors.reframe(move.turn_rad, *shift_m, move.down_m)


def _moved(step: TrailStep, move: FrameShift) -> TrailStep:
    north_m, east_m = move.place(step.north_m, step.east_m)
    return msgspec.structs.replace(step, north_m=north_m, east_m=east_m)
