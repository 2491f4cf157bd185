"""Solved paths: the past of units is solved again with their pins, and floors get new numbers."""

from __future__ import annotations

from collections.abc import Collection

from base_station.core.pins.evidence import reported_floors
from base_station.core.pins.pin_registry import resolve_later
from base_station.core.pins.pin_solver import renumbered_trail
from base_station.core.positioning.anchor_correction import relocate_unit
from base_station.core.positioning.unit_fusers import UnitFusers
from base_station.core.state import StationState
from base_station.fusion.interface import Fuser


def solve_pins(
    state: StationState, fusers: UnitFusers, unit_ids: Collection[str]
) -> dict[str, bool]:
    """Solve after a change of these units' pins; returns the units whose estimates changed, with
    True where the trail changed too. A reported floor numbers the storeys of its building for all
    units; one whose pin is in conflict does not.
    """

    def plain(unit_id: str) -> Fuser:
        return fusers.plain(state.units[unit_id])

    floors = state.learnt_floors
    numbers, storeys = floors.numbers, floors.storeys
    floors.set_reported_floors(reported_floors(state, unit_ids))
    solver = fusers.pinned.solver()
    units = [state.units[one] for one in unit_ids if one in state.units]
    relocated = [one for one in units if relocate_unit(state, one, fusers.plain(one), solver)]
    solved = fusers.pinned.solve(state, unit_ids, plain)
    if floors.set_reported_floors(reported_floors(state)):
        solved |= fusers.pinned.solve(state, unit_ids, plain)
    solved |= {unit.unit_id: True for unit in relocated}
    if floors.numbers != numbers:
        renumber(state)
    if floors.storeys != storeys:
        shown = [one for one, unit in state.units.items() if unit.place.fused is not None]
        for unit_id in shown:
            if unit_id not in solved:
                solved[unit_id] = False
                resolve_later(state, unit_id)
    return solved


def renumber(state: StationState) -> None:
    """Mark all trails for new floor numbers; they are renumbered one by one."""
    for history in state.paths.values():
        history.is_renumbered = True


def renumber_next_trail(state: StationState) -> str | None:
    """Renumber the next trail that waits for it; gives its unit where that changes the trail."""
    unit_id = next((one for one, path in state.paths.items() if path.is_renumbered), None)
    if unit_id is None:
        return None
    history, unit = state.paths[unit_id], state.units[unit_id]
    history.is_renumbered = False
    plain = unit.trails.plain
    if history.begin_ns is None or not plain:
        return None
    before = plain.copy()
    plain[:] = renumbered_trail(state, plain, history.arrays())
    return unit_id if plain is unit.trails.shown and plain != before else None
