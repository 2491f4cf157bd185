"""The incident frame moves: all that stands in it moves along."""

from __future__ import annotations

import msgspec

from base_station.live_state import StationState
from base_station.pins.book import reframe_pins
from base_station.units.trail import TrailStep
from shared.geo import rotate


def reframe(state: StationState, turn_rad: float, shift_m: tuple[float, float, float]) -> None:
    """Paths, trails, pins and what was learnt; the fusers move by themselves."""
    for history in state.paths.values():
        history.reframe(turn_rad, *shift_m)
    for unit in state.units.values():
        unit.trail = [_moved(step, turn_rad, shift_m) for step in unit.trail]
        if unit.plain_trail is not None:
            unit.plain_trail = [_moved(step, turn_rad, shift_m) for step in unit.plain_trail]
    state.learnt_building = state.learnt_building.reframed(turn_rad, *shift_m[:2])
    reframe_pins(state, turn_rad, shift_m[0], shift_m[1])
    state.learnt_floors.reframe(turn_rad, *shift_m)


def _moved(step: TrailStep, turn_rad: float, shift_m: tuple[float, float, float]) -> TrailStep:
    north_m, east_m = rotate(step.north_m, step.east_m, turn_rad)
    return msgspec.structs.replace(step, north_m=north_m + shift_m[0], east_m=east_m + shift_m[1])
