"""Correction of an anchor set by a person: fixes move on the plan, places given on the
plan stay.
"""

from __future__ import annotations

from base_station.core.pins.pin_solver import PathSolver, trail_of
from base_station.core.positioning.start_position import drop_learnt
from base_station.core.state import StationState, UnitState
from base_station.core.state.resolve_queue import request_resolve
from base_station.fusion.interface import Fuser


def move_fixes(
    state: StationState, site_id: str, turn_rad: float, north_m: float, east_m: float
) -> None:
    """Move the kept fixes of all units of a site; units that had any are relocated later, one a
    tick.
    """
    for unit_id, history in state.paths_on(site_id).items():
        if history.move_fixes(turn_rad, north_m, east_m):
            request_resolve(state.late, unit_id, state.t_ns)


def relocate_unit(state: StationState, unit: UnitState, fuser: Fuser, solver: PathSolver) -> bool:
    """Place a unit again by its moved fixes and other evidence, without pins; False where it was
    not due.
    """
    history = state.paths.get(unit.unit_id)
    if history is None or not history.is_refixed or history.begin_ns is None:
        return False
    history.is_refixed = False
    drop_learnt(state, unit.unit_id)
    path = solver.solve(state, unit.unit_id, ()).paths[unit.unit_id]
    fuser.set_posterior(path.posterior)
    unit.trails.replace_plain(0, trail_of(state, unit.unit_id, history.arrays(), path.places_m))
    return True
