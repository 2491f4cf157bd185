"""The anchor that a person had set was wrong: where satellites have somebody is elsewhere on the
plan, and what a person said of the plan stays.
"""

from __future__ import annotations

from base_station.fusion.port import Fuser
from base_station.live_state import StationState, UnitState
from base_station.pins.late_history import note_late
from base_station.pins.pinning import Past, trail_of
from base_station.positioning.unit_starts import unlearn


def move_fixes(state: StationState, turn_rad: float, north_m: float, east_m: float) -> None:
    """Whoever had any is to be placed again, one at a tick."""
    for unit_id, history in state.paths.items():
        if history.move_fixes(turn_rad, north_m, east_m):
            note_late(state.late, unit_id, state.t_ns)


def place_again(state: StationState, unit: UnitState, fuser: Fuser, past: Past) -> bool:
    """By the fixes where they are now, and all else but pins; whether that was to be done."""
    history = state.paths.get(unit.unit_id)
    if history is None or not history.is_refixed or history.begin_ns is None:
        return False
    history.is_refixed = False
    unlearn(state, unit.unit_id)
    path = past.solve(state, unit.unit_id, ()).paths[unit.unit_id]
    fuser.settle(path.present)
    unit.change_plain_trail(0, trail_of(state, history.arrays(), path.places_m))
    return True
