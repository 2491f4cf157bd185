"""Solved paths: paths of units are solved again with their pins, and floors are renumbered."""

from __future__ import annotations

from collections.abc import Collection

from base_station.core.pins.evidence import reported_floors
from base_station.core.pins.pin_registry import resolve_later
from base_station.core.pins.pin_solver import renumbered_trail
from base_station.core.positioning.anchor_correction import relocate_unit
from base_station.core.positioning.unit_fusers import UnitFusers
from base_station.core.state import OWN_SITE_ID, StationState
from base_station.fusion.interface import Fuser


def solve_pins(
    state: StationState, fusers: UnitFusers, unit_ids: Collection[str]
) -> dict[str, bool]:
    """Solve after a change of these units' pins; returns the units whose estimates changed, with
    True where the trail changed too.  Units that are not known yet are on the station's own site.
    """
    by_site: dict[str, list[str]] = {}
    for unit_id in unit_ids:
        unit = state.units.get(unit_id)
        by_site.setdefault(OWN_SITE_ID if unit is None else unit.site_id, []).append(unit_id)
    solved: dict[str, bool] = {}
    for site_id, some in (by_site or {OWN_SITE_ID: []}).items():
        solved |= _solve_site(state, fusers, site_id, some)
    return solved


def _solve_site(
    state: StationState, fusers: UnitFusers, site_id: str, unit_ids: Collection[str]
) -> dict[str, bool]:
    """``solve_pins`` of units of one site.  A reported floor numbers the storeys of its building
    for all units; one whose pin is in conflict does not.
    """
    site, grid = state.sites[site_id], fusers.grids.get(site_id)

    def plain(unit_id: str) -> Fuser:
        return fusers.plain(state.units[unit_id])

    floors = site.learnt_floors
    numbers, storeys = floors.numbers, floors.storeys
    floors.set_reported_floors(reported_floors(state, site, unit_ids))
    solver = fusers.pinned.solver(grid)
    units = [state.units[one] for one in unit_ids if one in state.units]
    relocated = [one for one in units if relocate_unit(state, one, fusers.plain(one), solver)]
    solved = fusers.pinned.solve(state, unit_ids, plain, grid)
    if floors.set_reported_floors(reported_floors(state, site)):
        solved |= fusers.pinned.solve(state, unit_ids, plain, grid)
    solved |= {unit.unit_id: True for unit in relocated}
    if floors.numbers != numbers:
        renumber(state, site_id)
    if floors.storeys != storeys:
        shown = [one.unit_id for one in state.units_on(site_id) if one.place.fused is not None]
        for unit_id in shown:
            if unit_id not in solved:
                solved[unit_id] = False
                resolve_later(state, unit_id)
    return solved


def renumber(state: StationState, site_id: str) -> None:
    """Mark all trails on a site for new floor numbers; they are renumbered one by one."""
    for history in state.paths_on(site_id).values():
        history.is_renumbered = True


def renumber_next_trail(state: StationState) -> str | None:
    """Renumber the next waiting trail; returns its unit where that changes the trail."""
    unit_id = next((one for one, path in state.paths.items() if path.is_renumbered), None)
    if unit_id is None:
        return None
    history, unit = state.paths[unit_id], state.units[unit_id]
    history.is_renumbered = False
    plain = unit.trails.plain
    if history.begin_ns is None or not plain:
        return None
    before = plain.copy()
    plain[:] = renumbered_trail(state.sites[unit.site_id], plain, history.arrays())
    return unit_id if plain is unit.trails.shown and plain != before else None
