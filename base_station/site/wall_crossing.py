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

FREE, BESIDE, WALL = 0, 1, 2  # kinds of squares; beside a wall there is no room for half a body

DIRECTIONS = 8  # into which is looked for room
SAME_WALL = 6.0  # squares within which two walls are one
MAX_WALLS = 12  # of a way that are remembered

# Flags of a square, of a climb beside stairs, and of a wall where one was met before.
Costs = tuple[float, float, float, float, float]

_COSTS = UniTuple(float64, 5)  # type: ignore[no-untyped-call]
_ROOM = UniTuple(float64, 2)  # type: ignore[no-untyped-call]
_compiled = partial(njit, cache=True, error_model="numpy")


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
    and columns; a way is looked at ``sampling`` squares apart.
    """
    last_row, last_column = ground.shape[0] - 1, ground.shape[1] - 1
    for one in range(len(begins)):
        longest = max(abs(ways[one, 0]), abs(ways[one, 1]))
        looks = max(1, math.ceil(longest / sampling))
        for move in range(moves.shape[1]):
            row = begins[one, 0] + moves[one, move, 0] + 0.5
            column = begins[one, 1] + moves[one, move, 1] + 0.5
            most = 0
            for step in range(1, looks + 1):
                part = step / looks
                at_row = min(max(math.floor(row + part * ways[one, 0]), 0), last_row)
                at_column = min(max(math.floor(column + part * ways[one, 1]), 0), last_column)
                most = max(most, ground[at_row, at_column])
                if most == WALL:
                    break
            worst[one, move] = most


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
            if ground[at_row, at_column] == WALL:
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
    in a second moving.  ``path`` (k, 4): rows and columns in the own frame, seconds moving, and
    whether it climbs.  A door that the plan lacks is crossed again on the way out: within
    ``SAME_WALL`` squares of an earlier crossing the last of the costs is taken.  Every ``room[0]``
    squares of way the logarithm of the free part of directions within ``room[1]`` squares is added
    to the second column.
    """
    last_row, last_column = ground.shape[0] - 1, ground.shape[1] - 1
    walls = np.empty((MAX_WALLS, 2))
    for one in range(len(heads)):
        met = 0
        row, column, cosine, sine, drift = heads[one]
        log, gone = logs[one, 0], 0.0
        for back in range(len(path)):
            if log < least:
                break
            rows, columns, moving_s, climbs = path[len(path) - 1 - back]
            way_row, way_column = cosine * rows - sine * columns, sine * rows + cosine * columns
            from_row, from_column = row - way_row, column - way_column
            looks = max(1, math.ceil(max(abs(way_row), abs(way_column)) / sampling))
            most = 0
            for step in range(1, looks + 1):
                part = step / looks
                at_row = math.floor(from_row + part * way_row + 0.5)
                at_column = math.floor(from_column + part * way_column + 0.5)
                at_row = min(max(at_row, 0), last_row)
                at_column = min(max(at_column, 0), last_column)
                most = max(most, ground[at_row, at_column])
                if most == WALL:
                    break
            cost = costs[most]
            if most == WALL:
                for last in range(met):
                    apart_rows, apart_columns = walls[last, 0] - row, walls[last, 1] - column
                    if max(abs(apart_rows), abs(apart_columns)) < SAME_WALL:
                        cost = costs[4]
                if met < MAX_WALLS:
                    walls[met, 0], walls[met, 1] = row, column
                    met += 1
            log += cost
            if climbs > 0.0:
                at_row = min(max(math.floor(row + 0.5), 0), stairs.shape[0] - 1)
                at_column = min(max(math.floor(column + 0.5), 0), stairs.shape[1] - 1)
                if not stairs[at_row, at_column]:
                    log += costs[3]
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
