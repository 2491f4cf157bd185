"""The last stretch of a path, to ask of any particle how well it fits the walls behind it."""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.wall_likelihood import BESIDE_WALL, OFF_STAIRS, THROUGH_WALL
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

KEPT_M = 30.0  # of path
LEG_M = 3.0  # walked until somebody might have turned
REACH_M = 1.5  # and gone so far
COSTS = 0.0, math.log(BESIDE_WALL), math.log(THROUGH_WALL), math.log(OFF_STAIRS)
WALLS, AGAIN = math.log(THROUGH_WALL), math.log(0.15)


class Move(msgspec.Struct, frozen=True, array_like=True):
    """From one look at the walls to the next."""

    north_m: float  # of the own path
    east_m: float
    moving_s: float
    climbs: bool
    floor: int | None  # None: its walls were not looked at
    told: float  # log likelihood of the walls met, by the cloud at the time


class RecentStretch:
    """Moves, the last one last."""

    def __init__(self, moves: list[Move]) -> None:
        self._moves = moves
        self._way_m = sum(_way_m(move) for move in moves)

    def save(self) -> list[Move]:
        return list(self._moves)

    @property
    def told(self) -> float:
        """How likely the cloud at each time has found the walls met, as a logarithm."""
        return sum(move.told for move in self._moves)

    def note(self, move: Move) -> None:
        self._moves.append(move)
        self._way_m += _way_m(move)
        while self._way_m > KEPT_M:
            self._way_m -= _way_m(self._moves.pop(0))

    def retell(self, told: float) -> None:
        """The cloud is another now, or the walls are, and it would have found them as likely as
        this.
        """
        whole, even = self.told, told / max(len(self._moves), 1)
        self._moves = [
            msgspec.structs.replace(move, told=told * move.told / whole if whole else even)
            for move in self._moves
        ]

    def met_behind(self, particles: Floats, scale: float, grid: FloorGrid, least: float) -> Floats:
        """Log likelihood (n,) of the walls met on the way to particles (n, 4) of north, east, turn
        and drift; what is once below ``least`` is not followed further back.
        """
        return self._follow_back(particles, scale, grid, (math.inf, least, AGAIN))[:, 0]

    def met_twice(self, particles: Floats, scale: float, grid: FloorGrid) -> Floats:
        """What more (n,) it would be if a wall that is met again were any wall."""
        all_met = self._follow_back(particles, scale, grid, (math.inf, -math.inf, WALLS))[:, 0]
        return all_met - self.met_behind(particles, scale, grid, -math.inf)

    def room_behind(self, particles: Floats, scale: float, grid: FloorGrid) -> Floats:
        """How much room there was on that way: the logarithm (n,) of the part of ways that would
        have met no wall.
        """
        return self._follow_back(particles, scale, grid, (LEG_M, -math.inf, AGAIN))[:, 1]

    def _follow_back(
        self, particles: Floats, scale: float, grid: FloorGrid, how: tuple[float, float, float]
    ) -> Floats:
        leg_m, least, again = how
        turn, logs = particles[:, 2], np.zeros((len(particles), 2))
        heads = np.column_stack((particles[:, :2], np.cos(turn), np.sin(turn), particles[:, 3]))
        for floor, moves in _by_floor(self._moves):
            path = np.array([(m.north_m, m.east_m, m.moving_s, m.climbs) for m in moves])
            path[:, :2] *= scale
            grid.go_back(floor, heads, path, (*COSTS, again), (leg_m, REACH_M), least, logs)
        return logs


def _by_floor(moves: list[Move]) -> list[tuple[int | None, list[Move]]]:
    """The last stretch first; in each the last move last."""
    runs: list[tuple[int | None, list[Move]]] = []
    for move in reversed(moves):
        if not runs or runs[-1][0] != move.floor:
            runs.append((move.floor, []))
        runs[-1][1].insert(0, move)
    return runs


def _way_m(move: Move) -> float:
    return math.hypot(move.north_m, move.east_m)
