"""Grid of a plan's walls and stairs: crossings of steps, and reachable areas."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.site.plan import Plan, Ring
from base_station.site.reachability import ReachableArea
from base_station.site.wall_crossing import (
    BESIDE,
    FREE,
    OUTSIDE,
    WALL,
    Costs,
    Ground,
    crossings_backward,
    crossings_shifted,
)

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Index = NDArray[np.intp]

CELL_M = 0.2
GROUND_FLOOR = 0  # as plans count
MARGIN_M = 3.0  # of open ground about the building
SAMPLING_M = 0.12  # how far apart a step is looked at: a wall is a square thick
MOST_CELLS = 4_000_000
PLACES_AT_ONCE = 200_000
LATTICE = 2  # squares between two points of the lattice: doors are wider
_OPEN = np.zeros((1, 1), dtype=np.uint8)
_EVERYWHERE = np.ones((1, 1), dtype=np.bool_)


class FreeLattice(NamedTuple):
    """Points of one floor, ``LATTICE`` squares apart, and the steps between neighbours that meet no
    wall.
    """

    is_free: Flags  # (r, c), no wall is there
    places_m: Floats  # (r, c, 2), north and east
    # Rows and columns where they begin and where they end, and the length of each, m.
    steps: tuple[tuple[tuple[Index, Index], tuple[Index, Index], float], ...]


class FloorGrid:
    """Grid of squares by floor; open ground without walls surrounds the plan."""

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
        self._within = np.logical_or.reduce([self._ring(ring) for ring in plan.outlines])
        self._ground = {
            floor: _ground(walls, self._within, floor) for floor, walls in self._walls.items()
        }
        on_stairs = {stairs.floor for stairs in plan.stairs}
        self._stairs = {floor: self._stairs_of(plan, floor) for floor in sorted(on_stairs)}

    @staticmethod
    def of(plan: Plan | None) -> FloorGrid | None:
        """Grid of a plan; None without walls, or where it is larger than any building."""
        if plan is None or not plan.walls or not plan.outlines:
            return None
        points = np.array([point for wall in plan.walls for point in wall.line])
        points = np.vstack([points, *(np.array(ring) for ring in plan.outlines)])
        spans_m = np.ptp(points, axis=0) + 2.0 * MARGIN_M
        return FloorGrid(plan) if float(np.prod(spans_m)) < MOST_CELLS * CELL_M**2 else None

    def has_floor(self, floor: int) -> bool:
        return floor in self._walls

    def crossings(self, floor: int, from_m: Floats, to_m: Floats) -> Ground:
        """Highest class of ground on straight steps (n, 2) -> (n, 2), north and east, on the floor
        (n,): ``FREE``, ``BESIDE`` a wall, a ``WALL`` that is entered, or ``OUTSIDE``.
        """
        ground = self._ground[floor]
        way_m = to_m - from_m
        looks = max(1, math.ceil(float(np.abs(way_m).max(initial=0.0)) / SAMPLING_M))
        parts = np.arange(looks + 1)[:, None] / looks
        north = self._rows(from_m[:, 0] + parts * way_m[:, 0])
        east = self._columns(from_m[:, 1] + parts * way_m[:, 1])
        passed = ground[north, east]
        stays = (passed[1:] == WALL) & (passed[:-1] == WALL)
        return np.asarray(np.where(stays, BESIDE, passed[1:]).max(axis=0), np.uint8)

    def crossings_shifted(
        self, floor: int, from_m: Floats, to_m: Floats, moves_m: Floats
    ) -> Ground:
        """Crossings of each step shifted by each of its shifts (n, g, 2): (n, g)."""
        corner = np.array([self._north_m, self._east_m])
        worst = np.empty(moves_m.shape[:2], dtype=np.uint8)
        begins, ways = (from_m - corner) / CELL_M, (to_m - from_m) / CELL_M
        crossings_shifted(
            self._ground[floor], begins, ways, moves_m / CELL_M, SAMPLING_M / CELL_M, worst
        )
        return worst

    def trace_back(
        self,
        floor: int | None,
        heads: Floats,
        path: Floats,
        costs: Costs,
        room_m: tuple[float, float],
        least: float,
        logs: Floats,
    ) -> None:
        """Trace heads (n, 5) back over a path (k, 5) walked on one floor: ``crossings_backward`` in
        metres. A floor that is not known has no walls.
        """
        corner = np.array([self._north_m, self._east_m])
        ground, stairs = _OPEN, _EVERYWHERE
        if floor is not None:
            ground, stairs = self._ground.get(floor, ground), self._stairs.get(floor, stairs)
        heads[:, :2] = (heads[:, :2] - corner) / CELL_M
        squares = path / (CELL_M, CELL_M, 1.0, 1.0, 1.0)
        room = room_m[0] / CELL_M, room_m[1] / CELL_M
        crossings_backward(
            ground, stairs, heads, squares, costs, SAMPLING_M / CELL_M, room, least, logs
        )
        heads[:, :2] = corner + CELL_M * heads[:, :2]

    def has_stairs(self, floor: int) -> bool:
        return floor in self._stairs

    def on_stairs(self, floor: int, place_m: Floats) -> Flags:
        """Flags of places (n, 2) on stairs."""
        rows, columns = self._rows(place_m[:, 0]), self._columns(place_m[:, 1])
        return np.asarray(self._stairs[floor][rows, columns])

    def is_in_building(self, place_m: Floats) -> Flags:
        """Flags of places (n, 2) in a building."""
        return np.asarray(self._within[self._rows(place_m[:, 0]), self._columns(place_m[:, 1])])

    @property
    def floors(self) -> tuple[int, ...]:
        """Floors of which the plan has walls."""
        return tuple(self._walls)

    def free_lattice(self, floor: int) -> FreeLattice:
        """Lattice of a floor.  A step to the side has no wall on its squares, one across none on
        those beside it either: it would slip through a wall that runs across.
        """
        free = ~self._walls[floor]
        is_free = free[::LATTICE, ::LATTICE]
        rows, columns = is_free.shape
        north_m = self._north_m + CELL_M * LATTICE * np.arange(rows)
        east_m = self._east_m + CELL_M * LATTICE * np.arange(columns)
        places_m = np.stack(np.meshgrid(north_m, east_m, indexing="ij"), axis=-1)
        side_m, across_m = LATTICE * CELL_M, LATTICE * CELL_M * math.sqrt(2.0)
        ways = (((0, 1), side_m), ((1, 0), side_m), ((1, 1), across_m), ((1, -1), across_m))
        steps = []
        for (north, east), length_m in ways:
            begin = np.nonzero(_free_steps(free, north, east))
            end = begin[0] + north, begin[1] + east
            steps.append(((begin[0], begin[1]), end, length_m))
        return FreeLattice(is_free, places_m, tuple(steps))

    def lattice_points(self, places_m: Floats) -> tuple[Index, Index]:
        """Rows and columns of the points of the lattice nearest to places (n, 2); beyond the
        plan's edge they are beyond the lattice's.
        """
        corner = np.array([self._north_m, self._east_m])
        points = np.rint((places_m - corner) / (CELL_M * LATTICE)).astype(np.intp)
        return points[:, 0], points[:, 1]

    def lattice_stairs(self, floor: int) -> Flags:
        """Points of the lattice on stairs."""
        return self._stairs[floor][::LATTICE, ::LATTICE]

    @property
    def area_m2(self) -> float:
        """Area of all buildings."""
        return float(np.count_nonzero(self._within)) * CELL_M**2

    def reachable_area(self, floor: int, north_m: float, east_m: float) -> ReachableArea | None:
        """Search from a place on one floor; None where the floor or the place is not on
        the plan.
        """
        if floor not in self._walls or not self._covers(north_m, east_m):
            return None
        at = (north_m - self._north_m) / CELL_M, (east_m - self._east_m) / CELL_M
        return ReachableArea(self._walls[floor], at, CELL_M)

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
        lines = [wall.line for wall in plan.walls if wall.floor == floor]
        begins = np.array([at for line in lines for at in line[:-1]])
        ends = np.array([at for line in lines for at in line[1:]])
        lengths_m = np.hypot(*(ends - begins).T)
        counts = np.maximum(2, np.ceil(lengths_m / (CELL_M / 4.0))).astype(np.intp)
        for some in _portions(counts):
            steps = counts[some] - 1
            which = np.repeat(np.arange(len(steps)), counts[some])
            first = np.repeat(np.cumsum(counts[some]) - counts[some], counts[some])
            number = np.arange(len(which)) - first
            parts = np.where(number == steps[which], 1.0, number * (1.0 / steps)[which])
            places = begins[some][which] + parts[:, None] * (ends - begins)[some][which]
            walls[self._rows(places[:, 1]), self._columns(places[:, 0])] = True
        return walls

    def _stairs_of(self, plan: Plan, floor: int) -> Flags:
        """The rings of a floor, even-odd, square by square."""
        stairs = np.zeros(self._shape, dtype=np.bool_)
        for one in plan.stairs:
            if one.floor == floor:
                stairs |= self._ring(one.ring)
        return stairs

    def _ring(self, ring: Ring) -> Flags:
        north_m = self._north_m + CELL_M * np.arange(self._shape[0])
        east_m = self._east_m + CELL_M * np.arange(self._shape[1])
        return _within(ring, north_m, east_m)


def _free_steps(free: Flags, north: int, east: int) -> Flags:
    """Points of the lattice from which a step to a neighbour, so many points north and east, is
    free: the block of squares that it spans is.
    """
    padded = np.pad(free, ((0, LATTICE), (LATTICE, LATTICE)))  # no way beyond the edge
    rows, columns = free[::LATTICE, ::LATTICE].shape
    is_free = np.ones((rows, columns), dtype=np.bool_)
    for row in range(LATTICE * north + 1):
        for column in range(LATTICE * abs(east) + 1):
            shift = LATTICE + (column if east >= 0 else -column)
            squares = padded[row::LATTICE, shift::LATTICE]
            is_free &= squares[:rows, :columns]
    return is_free


def _portions(counts: NDArray[np.intp]) -> Iterator[slice]:
    """Slices of places that fit in little memory."""
    begin, total = 0, 0
    for end, count in enumerate(counts.tolist(), 1):
        total += count
        if total >= PLACES_AT_ONCE or end == len(counts):
            yield slice(begin, end)
            begin, total = end, 0


def _ground(walls: Flags, within: Flags, floor: int) -> Ground:
    """Kinds of squares. Above the ground floor nobody walks out of the building; cellars may reach
    beyond its outlines.
    """
    ground = np.where(walls, WALL, np.where(_dilated(walls), BESIDE, FREE)).astype(np.uint8)
    if floor > GROUND_FLOOR:
        ground[~within & ~walls] = OUTSIDE
    return ground


def _dilated(cells: Flags) -> Flags:
    """With all cells that touch one of them, at a side or a corner."""
    around = np.pad(cells, 1)
    rows = around[:-2] | around[1:-1] | around[2:]
    return rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:]


def _within(ring: Ring, north_m: Floats, east_m: Floats) -> Flags:
    """Even-odd: a square is inside where an odd number of borders lies east of it."""
    changes = np.zeros((len(north_m), len(east_m) + 1), dtype=np.bool_)
    for (e0_m, n0_m), (e1_m, n1_m) in zip(ring, ring[1:] + ring[:1], strict=True):
        if n0_m == n1_m:
            continue
        rows = np.flatnonzero((n0_m > north_m) != (n1_m > north_m))
        borders_m = e0_m + (north_m[rows] - n0_m) * (e1_m - e0_m) / (n1_m - n0_m)
        changes[rows, np.searchsorted(east_m, borders_m)] ^= True
    return np.logical_xor.accumulate(changes[:, ::-1], axis=1)[:, -2::-1]
