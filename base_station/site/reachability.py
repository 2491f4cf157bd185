"""Area that a person can reach on a floor among walls, as it grows with time.  Compiled.

The way to each square is the shortest (Dijkstra 1959), over sides and corners of squares.  A search
continues from that of a shorter way, so that it costs only what it adds; it ends if the area
becomes too large to help a search on a plan.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numba import njit
from numba.core.types import boolean, float64, int64, uint8, void
from numpy.typing import NDArray

from base_station.site.plan import Ring

Flags = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

SECTORS = 48
MOST_SQUARES = 100_000  # of ground: beyond that the region without walls is as good

_ALONG, _ACROSS = 70, 99  # 99 / 70 is the root of two, but for 5e-5
_ROOM = 4096  # squares to be walked to next, at first
_SIZE, _WALKED = 0, 1  # of ``_counts``

_compiled = partial(njit, cache=True, error_model="numpy")


class ReachableArea:
    """Shortest ways from one position, continued as the way grows."""

    def __init__(self, walls: Flags, at: tuple[float, float], square_m: float) -> None:
        """``at``: the position in squares, rows and columns, on the floor."""
        self._walls, self._at, self._square_m = walls, at, square_m
        self._seen = np.zeros(walls.size // 8 + 1, dtype=np.uint8)  # a bit a square
        self._next: Indices = np.zeros(_ROOM, dtype=np.int64)  # a heap: way, then square
        row, column = (min(round(one), most - 1) for one, most in zip(at, walls.shape, strict=True))
        self._next[0] = row * walls.shape[1] + column
        self._counts = np.array([1, 0])
        self._inside = np.ones(SECTORS)  # in squares, in each direction
        self._beyond = np.full(SECTORS, -math.inf)  # the same, less the way to the plan's edge
        self._way = 0.0

    def reach_m(self, way_m: float) -> Floats | None:
        """Distance of the furthest square within ``way_m`` by direction (``SECTORS``, clockwise
        from north); None: the area is too large.  ``way_m`` may not fall from call to call.  Beyond
        the plan's edge there are no walls.
        """
        self._way = max(self._way, way_m / self._square_m)
        while not _expand(
            self._walls,
            self._seen,
            self._next,
            self._counts,
            self._inside,
            self._beyond,
            *self._at,
            int(self._way * _ALONG),
        ):
            self._next = np.concatenate([self._next, np.zeros_like(self._next)])
        if self._counts[_WALKED] >= MOST_SQUARES:
            self._seen, self._next = self._seen[:0], self._next[:0]
            self._counts[_SIZE] = 0
            return None
        return np.maximum(self._inside, self._beyond + self._way) * self._square_m


def ring_about(north_m: float, east_m: float, reach_m: Floats) -> Ring:
    """Ring of (east_m, north_m) about a place, from its distances by direction."""
    angles_rad = np.arange(SECTORS) * math.tau / SECTORS
    ring_east_m = east_m + reach_m * np.sin(angles_rad)
    ring_north_m = north_m + reach_m * np.cos(angles_rad)
    return tuple(zip(ring_east_m.tolist(), ring_north_m.tolist(), strict=True))


@_compiled(int64(int64[::1], int64))
def _heap_pop(heap: Indices, size: int) -> int:
    """Remove the least value of a heap of ``size``."""
    least, last = heap[0], heap[size - 1]
    at = 0
    while 2 * at + 1 < size - 1:
        child = 2 * at + 1
        if child + 1 < size - 1 and heap[child + 1] < heap[child]:
            child += 1
        if last <= heap[child]:
            break
        heap[at] = heap[child]
        at = child
    heap[at] = last
    return int(least)


@_compiled(void(int64[::1], int64, int64))
def _heap_push(heap: Indices, size: int, value: int) -> None:
    at = size
    while at > 0 and heap[(at - 1) // 2] > value:
        heap[at] = heap[(at - 1) // 2]
        at = (at - 1) // 2
    heap[at] = value


@_compiled(
    boolean(
        boolean[:, ::1],
        uint8[::1],
        int64[::1],
        int64[::1],
        float64[::1],
        float64[::1],
        float64,
        float64,
        int64,
    )
)
def _expand(
    walls: Flags,
    seen: NDArray[np.uint8],
    heap: Indices,
    counts: Indices,
    inside: Floats,
    beyond: Floats,
    from_row: float,
    from_column: float,
    way: int,
) -> bool:
    """Expand squares up to a way.  False if the heap is full and must be enlarged."""
    rows, columns = walls.shape
    while counts[_SIZE] > 0 and counts[_WALKED] < MOST_SQUARES and heap[0] >> 32 <= way:
        if counts[_SIZE] + 8 > len(heap):
            return False
        walked, square = divmod(_heap_pop(heap, counts[_SIZE]), 1 << 32)
        counts[_SIZE] -= 1
        if seen[square >> 3] >> (square & 7) & 1:
            continue
        seen[square >> 3] |= 1 << (square & 7)
        counts[_WALKED] += 1
        row, column = divmod(square, columns)
        north, east = row - from_row, column - from_column
        far = math.hypot(north, east)
        sector = round(math.atan2(east, north) / math.tau * SECTORS) % SECTORS
        inside[sector] = max(inside[sector], far)
        if row in (0, rows - 1) or column in (0, columns - 1):
            beyond[sector] = max(beyond[sector], far - walked / _ALONG)
        for to_row in range(max(row - 1, 0), min(row + 2, rows)):
            for to_column in range(max(column - 1, 0), min(column + 2, columns)):
                to = to_row * columns + to_column
                if walls[to_row, to_column] or seen[to >> 3] >> (to & 7) & 1:
                    continue
                step = _ALONG if to_row == row or to_column == column else _ACROSS
                _heap_push(heap, counts[_SIZE], (walked + step) << 32 | to)
                counts[_SIZE] += 1
    return True
