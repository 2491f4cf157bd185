"""Which of many ways a wall cuts, compiled."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numba import njit
from numba.core.types import boolean, float64, uint8, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_compiled = partial(njit, cache=True, error_model="numpy")


@_compiled(
    void(
        boolean[:, ::1],
        float64[:, ::1],
        float64[:, ::1],
        float64[:, :, ::1],
        float64,
        uint8[:, ::1],
    )
)
def cross_moved(
    walls: Flags, begins: Floats, ways: Floats, moves: Floats, look: float, cut: NDArray[np.uint8]
) -> None:
    """Straight ways, each moved by each of its moves: 1 in ``cut`` (n, g) where a wall's square is
    met.  ``begins``, ``ways`` (n, 2) and ``moves`` (n, g, 2) are in squares, rows and columns;
    a way is looked at ``look`` squares apart.
    """
    last_row, last_column = walls.shape[0] - 1, walls.shape[1] - 1
    for one in range(len(begins)):
        longest = max(abs(ways[one, 0]), abs(ways[one, 1]))
        looks = max(1, math.ceil(longest / look))
        for move in range(moves.shape[1]):
            row = begins[one, 0] + moves[one, move, 0] + 0.5
            column = begins[one, 1] + moves[one, move, 1] + 0.5
            cut[one, move] = 0
            for step in range(1, looks + 1):
                part = step / looks
                at_row = min(max(math.floor(row + part * ways[one, 0]), 0), last_row)
                at_column = min(max(math.floor(column + part * ways[one, 1]), 0), last_column)
                if walls[at_row, at_column]:
                    cut[one, move] = 1
                    break
