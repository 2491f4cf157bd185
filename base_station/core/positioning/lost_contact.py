"""Reachable area of members without contact, on a plan."""

from __future__ import annotations

from base_station.core.state import UnitState
from base_station.site.floor_grid import FloorGrid
from base_station.site.max_travel import RADII_95, max_travel_m
from base_station.site.plan import Ring
from base_station.site.reachability import ReachableArea, ring_about
from shared.clock import NS_PER_S
from shared.messages import FusedPosition


class LostContact:
    """Search continued from the last second for each member still without contact."""

    def __init__(self, grid: FloorGrid | None) -> None:
        self._grid = grid
        self._areas: dict[str, tuple[FusedPosition, ReachableArea]] = {}

    def reach(self, t_ns: int, unit: UnitState) -> Ring:
        """Border of the area reachable since the last contact, on the floor of the last position;
        empty with contact, without a plan, or where the area is too large.
        """
        fused = unit.place.fused
        reachable_area = None if unit.link == "live" else self._reachable_area(unit.unit_id, fused)
        if fused is None or reachable_area is None:
            self._areas.pop(unit.unit_id, None)
            return ()
        self._areas[unit.unit_id] = fused, reachable_area
        known_m = RADII_95 * max(fused.std_north_m, fused.std_east_m)
        reach_m = reachable_area.reach_m(
            known_m + max_travel_m((t_ns - fused.t_meas_ns) / NS_PER_S)
        )
        return () if reach_m is None else ring_about(fused.north_m, fused.east_m, reach_m)

    def _reachable_area(self, unit_id: str, fused: FusedPosition | None) -> ReachableArea | None:
        if self._grid is None or fused is None or fused.floor is None:
            return None
        before, reachable_area = self._areas.get(unit_id, (None, None))
        if before is fused:
            return reachable_area
        return self._grid.reachable_area(fused.floor, fused.north_m, fused.east_m)
