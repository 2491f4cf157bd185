"""Wall crossings of many straight steps over a floor's grid, compiled."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numba import njit
from numba.core.types import UniTuple, boolean, float64, uint8, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ground = NDArray[np.uint8]
Flags = NDArray[np.bool_]

# Kinds of squares: beside a wall there is no room for half a body, and outside of the outlines
# above the ground floor there is air.
FREE, BESIDE, WALL, OUTSIDE = 0, 1, 2, 3

OFF_STAIRS, MET_BEFORE = 4, 5  # of the costs

DIRECTIONS = 8  # into which is looked for room
SAME_WALL = 6.0  # squares within which two walls are one
MAX_WALLS = 12  # of a way that are remembered

# Of each kind of square, of a climb beside stairs, and of a wall where one was met before.
Costs = tuple[float, float, float, float, float, float]

_COSTS = UniTuple(float64, 6)  # type: ignore[no-untyped-call]
_ROOM = UniTuple(float64, 2)  # type: ignore[no-untyped-call]
_compiled = partial(njit, cache=True, error_model="numpy")


@_compiled(uint8(uint8[:, ::1], float64, float64, float64, float64, float64))
def crossing(
    ground: Ground, row: float, column: float, rows: float, columns: float, sampling: float
) -> int:
    """Highest class of ground on a straight step from a position by a number of rows and columns.

    A wall counts where it is entered: a step along it or out of it does not cross it again.
    """
    last_row, last_column = ground.shape[0] - 1, ground.shape[1] - 1
    looks = max(1, math.ceil(max(abs(rows), abs(columns)) / sampling))
    most, before = FREE, FREE
    for step in range(looks + 1):
        part = step / looks
        at_row = min(max(math.floor(row + part * rows + 0.5), 0), last_row)
        at_column = min(max(math.floor(column + part * columns + 0.5), 0), last_column)
        here = ground[at_row, at_column]
        if step > 0:
            most = max(most, BESIDE if here == WALL and before == WALL else here)
        before = here
    return most


@_compiled(
    void(
        uint8[:, ::1],
        float64[:, ::1],
        float64[:, ::1],
        float64[:, :, ::1],
        float64,
        uint8[:, ::1],
    )
)
def crossings_shifted(
    ground: Ground, begins: Floats, ways: Floats, moves: Floats, sampling: float, worst: Ground
) -> None:
    """Highest class of ground on each straight step, shifted by each of its shifts; into ``worst``
    (n, g).  ``begins``, ``ways`` (n, 2) and ``moves`` (n, g, 2) are in squares, rows
    and columns; a way is looked at ``sampling`` squares apart (``crossing``).
    """
    for one in range(len(begins)):
        for move in range(moves.shape[1]):
            row, column = begins[one] + moves[one, move]
            worst[one, move] = crossing(ground, row, column, ways[one, 0], ways[one, 1], sampling)


@_compiled(float64(uint8[:, ::1], float64, float64, float64))
def free_fraction(ground: Ground, row: float, column: float, reach: float) -> float:
    """Part of ``DIRECTIONS`` without a wall within reach (squares); above 0, for its logarithm."""
    last_row, last_column = ground.shape[0] - 1, ground.shape[1] - 1
    free = 0.5
    for one in range(DIRECTIONS):
        angle = 2.0 * math.pi * one / DIRECTIONS
        rows, columns = math.cos(angle), math.sin(angle)
        for step in range(1, math.ceil(reach) + 1):
            at_row = min(max(math.floor(row + step * rows + 0.5), 0), last_row)
            at_column = min(max(math.floor(column + step * columns + 0.5), 0), last_column)
            if ground[at_row, at_column] >= WALL:
                break
        else:
            free += 1.0
    return free / (DIRECTIONS + 0.5)


@_compiled(
    void(
        uint8[:, ::1],
        boolean[:, ::1],
        float64[:, ::1],
        float64[:, ::1],
        _COSTS,
        float64,
        _ROOM,
        float64,
        float64[:, ::1],
    )
)
def crossings_backward(
    ground: Ground,
    stairs: Flags,
    heads: Floats,
    path: Floats,
    costs: Costs,
    sampling: float,
    room: tuple[float, float],
    least: float,
    logs: Floats,
) -> None:
    """Trace each head (n, 5) back along a path and add the costs of what it crosses to ``logs``
    (n, 2), logarithms; one whose sum falls below ``least`` stops, others end where the path begins.

    A head is row and column, cosine and sine of its own frame's turn, and by how much that grows
    in a second moving.  ``path`` (k, 5): rows and columns in the own frame, seconds moving, whether
    it climbs, and the cost of a step beside a wall, which is taken instead of that in ``costs``.  A
    door that the plan lacks is crossed again on the way out: within ``SAME_WALL`` squares of an
    earlier crossing the last of the costs is taken.  Every ``room[0]`` squares of way the logarithm
    of the free part of directions within ``room[1]`` squares is added to the second column.
    """
    walls = np.empty((MAX_WALLS, 2))
    for one in range(len(heads)):
        met = 0
        row, column, cosine, sine, drift = heads[one]
        log, gone = logs[one, 0], 0.0
        for back in range(len(path)):
            if log < least:
                break
            rows, columns, moving_s, climbs, beside = path[len(path) - 1 - back]
            way_row, way_column = cosine * rows - sine * columns, sine * rows + cosine * columns
            from_row, from_column = row - way_row, column - way_column
            most = crossing(ground, from_row, from_column, way_row, way_column, sampling)
            cost = beside if most == BESIDE else costs[most]
            if most == WALL:
                for last in range(met):
                    apart_rows, apart_columns = walls[last, 0] - row, walls[last, 1] - column
                    if max(abs(apart_rows), abs(apart_columns)) < SAME_WALL:
                        cost = costs[MET_BEFORE]
                if met < MAX_WALLS:
                    walls[met, 0], walls[met, 1] = row, column
                    met += 1
            log += cost
            if climbs > 0.0:
                at_row = min(max(math.floor(row + 0.5), 0), stairs.shape[0] - 1)
                at_column = min(max(math.floor(column + 0.5), 0), stairs.shape[1] - 1)
                if not stairs[at_row, at_column]:
                    log += costs[OFF_STAIRS]
            gone += math.hypot(rows, columns)
            if gone > room[0]:
                gone = 0.0
                logs[one, 1] += math.log(free_fraction(ground, row, column, room[1]))
            turned = drift * moving_s
            less, more = math.cos(turned), math.sin(turned)
            cosine, sine = cosine * less + sine * more, sine * less - cosine * more
            row, column = from_row, from_column
        heads[one, 0], heads[one, 1], heads[one, 2], heads[one, 3] = row, column, cosine, sine
        logs[one, 0] = log
