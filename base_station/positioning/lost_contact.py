"""Where people who are not heard can have walked to, as far as a plan tells."""

from __future__ import annotations

from base_station.live_state import UnitState
from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import Ring
from base_station.site.roaming import RADII_95, roamed_m
from base_station.site.way_out import WayOut, ring_about
from shared.clock import NS_PER_S
from shared.messages import FusedPosition


class LostContact:
    """Goes on from what was walked a second before, for whoever is still not heard."""

    def __init__(self, grid: FloorGrid | None) -> None:
        self._grid = grid
        self._ways: dict[str, tuple[FusedPosition, WayOut]] = {}

    def reach(self, t_ns: int, unit: UnitState) -> Ring:
        """The border of what somebody who is not heard can have walked to since, on the floor
        where that was; empty where no plan tells, the ground is too much, or somebody is heard.
        """
        fused = unit.fused
        way_out = None if unit.link == "live" else self._way_out(unit.unit_id, fused)
        if fused is None or way_out is None:
            self._ways.pop(unit.unit_id, None)
            return ()
        self._ways[unit.unit_id] = fused, way_out
        known_m = RADII_95 * max(fused.std_north_m, fused.std_east_m)
        reach_m = way_out.reach_m(known_m + roamed_m((t_ns - fused.t_meas_ns) / NS_PER_S))
        return () if reach_m is None else ring_about(fused.north_m, fused.east_m, reach_m)

    def _way_out(self, unit_id: str, fused: FusedPosition | None) -> WayOut | None:
        if self._grid is None or fused is None or fused.floor is None:
            return None
        before, way_out = self._ways.get(unit_id, (None, None))
        if before is fused:
            return way_out
        return self._grid.way_out(fused.floor, fused.north_m, fused.east_m)
