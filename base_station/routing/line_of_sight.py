"""Corners of a way: a straight walk becomes one line."""

from __future__ import annotations

import numpy as np

from base_station.routing.interface import Floats
from base_station.site.floor_grid import FloorGrid
from base_station.site.simplified_line import corners
from base_station.site.wall_crossing import WALL

TOLERANCE_M = 0.7  # of a way over cells: their places are as uncertain
_BEYOND = 400  # nodes that one line may span: 160 m


def straightened(places_m: Floats, floor: int | None, grid: FloorGrid | None) -> Floats:
    """Corners (k, 2) of a way (n, 2) on one floor, both ends among them.

    Among the walls of a plan each line goes as far as there is no wall on it; elsewhere the way is
    thinned by Douglas and Peucker (1973).
    """
    if grid is None or floor is None or not grid.has_floor(floor):
        return places_m[corners(places_m, TOLERANCE_M)]
    kept, at, last = [0], 0, len(places_m) - 1
    while at < last:
        at = _furthest_seen(places_m, at, min(last, at + _BEYOND), floor, grid)
        kept.append(at)
    return places_m[kept]


def _furthest_seen(places_m: Floats, at: int, last: int, floor: int, grid: FloorGrid) -> int:
    """Last of the following nodes without a wall between; at least the next one."""
    ahead = np.arange(at + 1, last + 1)
    begins_m = np.broadcast_to(places_m[at], (len(ahead), 2))
    is_free = grid.crossings(floor, begins_m, places_m[ahead]) != WALL
    return int(ahead[is_free][-1]) if is_free.any() else at + 1
