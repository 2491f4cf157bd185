"""Motion window: the recent stretch of a path, traced back from any particle to check it against
walls.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.state import SCALE
from base_station.fusion.wall_likelihood import (
    BESIDE_WALL,
    OFF_FLOOR,
    OFF_STAIRS,
    THROUGH_WALL,
)
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

KEPT_M = 30.0  # of path
LEG_M = 3.0  # walked until the wearer might have turned
REACH_M = 1.5  # and gone so far
# By kind of square, and of a climb beside stairs. What room beside walls costs depends on the step.
COSTS = (
    0.0,
    0.0,
    math.log(THROUGH_WALL),
    math.log(OFF_FLOOR),
    math.log(OFF_STAIRS),
)
ANY_WALL, REPEATED_WALL = math.log(THROUGH_WALL), math.log(0.15)


class MotionStep(msgspec.Struct, frozen=True, array_like=True):
    """Movement between two checks of the walls."""

    north_m: float  # of the own path
    east_m: float
    moving_s: float
    climbs: bool
    floor: int | None  # None: its walls were not looked at
    log_likelihood: float  # log likelihood of the walls met, by the cloud at the time
    log_beside: float = math.log(BESIDE_WALL)  # of a particle that passes beside a wall


class MotionWindow:
    """Moves, the last one last."""

    def __init__(self, moves: list[MotionStep]) -> None:
        self._moves = moves
        self._way_m = sum(_way_m(move) for move in moves)

    def save(self) -> list[MotionStep]:
        return list(self._moves)

    @property
    def log_likelihood(self) -> float:
        """Log likelihood of the walls along the window, as the cloud found it step by step."""
        return sum(move.log_likelihood for move in self._moves)

    def append(self, move: MotionStep) -> None:
        self._moves.append(move)
        self._way_m += _way_m(move)
        while self._way_m > KEPT_M:
            self._way_m -= _way_m(self._moves.pop(0))

    def set_log_likelihood(self, log_likelihood: float) -> None:
        """Set the log likelihood of the window for another cloud or other walls, spread over its
        steps.
        """
        whole, even = self.log_likelihood, log_likelihood / max(len(self._moves), 1)
        self._moves = [
            msgspec.structs.replace(
                move, log_likelihood=log_likelihood * move.log_likelihood / whole if whole else even
            )
            for move in self._moves
        ]

    def wall_log_likelihood(self, particles: Floats, grid: FloorGrid, least: float) -> Floats:
        """Log likelihood (n,) of the walls met on the way to particles (n, 5) of north, east, turn,
        drift and scale; what is once below ``least`` is not followed further back.
        """
        return self._trace_back(particles, grid, (math.inf, least, REPEATED_WALL))[:, 0]

    def repeated_wall_log_ratio(self, particles: Floats, grid: FloorGrid) -> Floats:
        """Difference (n,) of log likelihood if a repeated crossing counted as a new wall."""
        all_met = self._trace_back(particles, grid, (math.inf, -math.inf, ANY_WALL))[:, 0]
        return all_met - self.wall_log_likelihood(particles, grid, -math.inf)

    def log_free_fraction(self, particles: Floats, grid: FloorGrid) -> Floats:
        """Logarithm (n,) of the part of possible ways that would have crossed no wall."""
        return self._trace_back(particles, grid, (LEG_M, -math.inf, REPEATED_WALL))[:, 1]

    def _trace_back(
        self, particles: Floats, grid: FloorGrid, how: tuple[float, float, float]
    ) -> Floats:
        segment_m, least, again = how
        turn, scale, logs = particles[:, 2], particles[:, SCALE], np.zeros((len(particles), 2))
        heads = np.column_stack(
            (particles[:, :2], scale * np.cos(turn), scale * np.sin(turn), particles[:, 3])
        )
        for floor, moves in _by_floor(self._moves):
            path = np.array(
                [(m.north_m, m.east_m, m.moving_s, m.climbs, m.log_beside) for m in moves]
            )
            grid.trace_back(floor, heads, path, (*COSTS, again), (segment_m, REACH_M), least, logs)
        return logs


def _by_floor(moves: list[MotionStep]) -> list[tuple[int | None, list[MotionStep]]]:
    """The last stretch first; in each the last move last."""
    runs: list[tuple[int | None, list[MotionStep]]] = []
    for move in reversed(moves):
        if not runs or runs[-1][0] != move.floor:
            runs.append((move.floor, []))
        runs[-1][1].insert(0, move)
    return runs


def _way_m(move: MotionStep) -> float:
    return math.hypot(move.north_m, move.east_m)
