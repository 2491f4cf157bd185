"""What many ways over a floor meet, compiled."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numba import njit
from numba.core.types import float64, uint8, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ground = NDArray[np.uint8]

FREE, BESIDE, WALL = 0, 1, 2  # what a square is; beside a wall there is no room for half a body

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
def meet_moved(
    ground: Ground, begins: Floats, ways: Floats, moves: Floats, look: float, worst: Ground
) -> None:
    """Straight ways, each moved by each of its moves: the highest square of the ground that is met,
    in ``worst`` (n, g).  ``begins``, ``ways`` (n, 2) and ``moves`` (n, g, 2) are in squares, rows
    and columns; a way is looked at ``look`` squares apart.
    """
    last_row, last_column = ground.shape[0] - 1, ground.shape[1] - 1
    for one in range(len(begins)):
        longest = max(abs(ways[one, 0]), abs(ways[one, 1]))
        looks = max(1, math.ceil(longest / look))
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
