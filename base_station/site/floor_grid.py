"""A plan's walls and stairs as squares: what a step crosses, and where ways out begin."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from base_station.site.crossing import BESIDE, FREE, WALL, Costs, Ground, meet_behind, meet_moved
from base_station.site.plan import Plan, Ring
from base_station.site.way_out import WayOut

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

CELL_M = 0.2
MARGIN_M = 3.0  # of open ground about the building
LOOK_M = 0.12  # how far apart a step is looked at: a wall is a square thick
MOST_CELLS = 4_000_000
_OPEN = np.zeros((1, 1), dtype=np.uint8)
_EVERYWHERE = np.ones((1, 1), dtype=np.bool_)


class FloorGrid:
    """Open ground surrounds what the plan shows; nothing stands in the way there."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        lines = [*plan.outlines, *(wall.line for wall in plan.walls)]
        points = np.array([point for line in lines for point in line])
        low, high = points.min(axis=0) - MARGIN_M, points.max(axis=0) + MARGIN_M
        self._east_m, self._north_m = float(low[0]), float(low[1])
        self._shape = (
            math.ceil((high[1] - low[1]) / CELL_M) + 1,
            math.ceil((high[0] - low[0]) / CELL_M) + 1,
        )
        floors = {wall.floor for wall in plan.walls}
        self._walls = {floor: self._walls_of(plan, floor) for floor in sorted(floors)}
        self._ground = {floor: _ground(walls) for floor, walls in self._walls.items()}
        self._within = np.logical_or.reduce([self._ring(ring) for ring in plan.outlines])
        on_stairs = {stairs.floor for stairs in plan.stairs}
        self._stairs = {floor: self._stairs_of(plan, floor) for floor in sorted(on_stairs)}

    @staticmethod
    def of(plan: Plan | None) -> FloorGrid | None:
        """None where the plan shows no walls, or is larger than any building."""
        if plan is None or not plan.walls or not plan.outlines:
            return None
        points = np.array([point for wall in plan.walls for point in wall.line])
        points = np.vstack([points, *(np.array(ring) for ring in plan.outlines)])
        spans_m = np.ptp(points, axis=0) + 2.0 * MARGIN_M
        return FloorGrid(plan) if float(np.prod(spans_m)) < MOST_CELLS * CELL_M**2 else None

    def knows(self, floor: int) -> bool:
        return floor in self._walls

    def met(self, floor: int, from_m: Floats, to_m: Floats) -> Ground:
        """The worst that straight ways (n, 2) -> (n, 2), north and east, meet on the floor (n,):
        ``FREE``, ``BESIDE`` a wall, or a ``WALL``.
        """
        ground = self._ground[floor]
        way_m = to_m - from_m
        looks = max(1, math.ceil(float(np.abs(way_m).max(initial=0.0)) / LOOK_M))
        parts = np.arange(1, looks + 1)[:, None] / looks
        north = self._rows(from_m[:, 0] + parts * way_m[:, 0])
        east = self._columns(from_m[:, 1] + parts * way_m[:, 1])
        return np.asarray(ground[north, east].max(axis=0))

    def met_moved(self, floor: int, from_m: Floats, to_m: Floats, moves_m: Floats) -> Ground:
        """The same of each way moved by each of its moves (n, g, 2): (n, g)."""
        corner = np.array([self._north_m, self._east_m])
        worst = np.empty(moves_m.shape[:2], dtype=np.uint8)
        begins, ways = (from_m - corner) / CELL_M, (to_m - from_m) / CELL_M
        meet_moved(self._ground[floor], begins, ways, moves_m / CELL_M, LOOK_M / CELL_M, worst)
        return worst

    def go_back(
        self,
        floor: int | None,
        heads: Floats,
        path: Floats,
        costs: Costs,
        room_m: tuple[float, float],
        least: float,
        logs: Floats,
    ) -> None:
        """Follow heads (n, 5) back over a path (k, 4) that was walked on one floor; as
        ``meet_behind``, in metres.  A floor that is not known has no walls.
        """
        corner = np.array([self._north_m, self._east_m])
        ground, stairs = _OPEN, _EVERYWHERE
        if floor is not None:
            ground, stairs = self._ground.get(floor, ground), self._stairs.get(floor, stairs)
        heads[:, :2] = (heads[:, :2] - corner) / CELL_M
        squares = path / (CELL_M, CELL_M, 1.0, 1.0)
        room = room_m[0] / CELL_M, room_m[1] / CELL_M
        meet_behind(ground, stairs, heads, squares, costs, LOOK_M / CELL_M, room, least, logs)
        heads[:, :2] = corner + CELL_M * heads[:, :2]

    def has_stairs(self, floor: int) -> bool:
        return floor in self._stairs

    def on_stairs(self, floor: int, place_m: Floats) -> Flags:
        """Which places (n, 2) lie where people change floor."""
        rows, columns = self._rows(place_m[:, 0]), self._columns(place_m[:, 1])
        return np.asarray(self._stairs[floor][rows, columns])

    def is_within(self, place_m: Floats) -> Flags:
        """Which places (n, 2) lie in a building."""
        return np.asarray(self._within[self._rows(place_m[:, 0]), self._columns(place_m[:, 1])])

    @property
    def area_m2(self) -> float:
        """Of the ground that buildings stand on."""
        return float(np.count_nonzero(self._within)) * CELL_M**2

    def way_out(self, floor: int, north_m: float, east_m: float) -> WayOut | None:
        """From a place on one floor; None where the floor or the place is not on the plan."""
        if floor not in self._walls or not self._covers(north_m, east_m):
            return None
        at = (north_m - self._north_m) / CELL_M, (east_m - self._east_m) / CELL_M
        return WayOut(self._walls[floor], at, CELL_M)

    def _covers(self, north_m: float, east_m: float) -> bool:
        row, column = (north_m - self._north_m) / CELL_M, (east_m - self._east_m) / CELL_M
        return bool(0.0 <= row < self._shape[0] and 0.0 <= column < self._shape[1])

    def _rows(self, north_m: Floats) -> NDArray[np.intp]:
        return np.clip(
            np.rint((north_m - self._north_m) / CELL_M).astype(np.intp), 0, self._shape[0] - 1
        )

    def _columns(self, east_m: Floats) -> NDArray[np.intp]:
        return np.clip(
            np.rint((east_m - self._east_m) / CELL_M).astype(np.intp), 0, self._shape[1] - 1
        )

    def _walls_of(self, plan: Plan, floor: int) -> Flags:
        walls = np.zeros(self._shape, dtype=np.bool_)
        for wall in plan.walls:
            if wall.floor != floor:
                continue
            for (e0_m, n0_m), (e1_m, n1_m) in zip(wall.line, wall.line[1:], strict=False):
                count = max(2, math.ceil(math.hypot(e1_m - e0_m, n1_m - n0_m) / (CELL_M / 4.0)))
                parts = np.linspace(0.0, 1.0, count)
                rows = self._rows(n0_m + parts * (n1_m - n0_m))
                walls[rows, self._columns(e0_m + parts * (e1_m - e0_m))] = True
        return walls

    def _stairs_of(self, plan: Plan, floor: int) -> Flags:
        """The rings of a floor, even-odd, square by square."""
        stairs = np.zeros(self._shape, dtype=np.bool_)
        for one in plan.stairs:
            if one.floor == floor:
                stairs |= self._ring(one.ring)
        return stairs

    def _ring(self, ring: Ring) -> Flags:
        north_m = self._north_m + CELL_M * np.arange(self._shape[0])[:, None]
        east_m = self._east_m + CELL_M * np.arange(self._shape[1])[None, :]
        return _within(ring, north_m, east_m)


def _ground(walls: Flags) -> Ground:
    beside = binary_dilation(walls, np.ones((3, 3), dtype=np.bool_))
    return np.where(walls, WALL, np.where(beside, BESIDE, FREE)).astype(np.uint8)


def _within(ring: Ring, north_m: Floats, east_m: Floats) -> Flags:
    inside = np.zeros(np.broadcast_shapes(north_m.shape, east_m.shape), dtype=np.bool_)
    for (e0_m, n0_m), (e1_m, n1_m) in zip(ring, ring[1:] + ring[:1], strict=True):
        if n0_m == n1_m:
            continue
        beside = (n0_m > north_m) != (n1_m > north_m)
        inside ^= beside & (east_m < e0_m + (north_m - n0_m) * (e1_m - e0_m) / (n1_m - n0_m))
    return inside
