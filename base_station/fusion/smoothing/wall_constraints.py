"""Wall constraints: likelihood of each segment of a path on a plan, as information about its place.

A segment of some metres is placed on a grid about its estimate without its own message; places
whose steps cross a wall lose weight. The rest is approximated by a normal distribution, and what it
adds is the segment's message, an equation of the problem (expectation propagation: Minka 2001).
Messages are updated about each solution until nothing moves. A segment known no better than a room
has no message: walls leave it several places, of which a normal distribution is none.

A plan lies some decimetres off for all units alike: places here are those of the plan, and its
offset is a shared unknown.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.odometry.points import BREAK, RESTART
from base_station.fusion.smoothing.chain import STATES, Chain, PathEstimate, place_of
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.wall_likelihood import (
    CLIMBS,
    OFF_FLOOR,
    OFF_STAIRS,
    THROUGH_WALL,
    UNSEEN_M,
    log_beside_wall,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.wall_crossing import BESIDE, OUTSIDE, WALL

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GRID_POINTS = 11  # places each way, within
GRID_HALF_WIDTH = 2.5  # standard deviations
SHARPEST_M = 0.01  # no constraint is sharper
KNOWN_STD_M = 1.0  # of a segment by all others, along its worse axis; beyond, it has no message
LEAST_PART = 0.05  # of the information on a piece must come from others
DAMPING = 0.6  # of a new message is taken


def _grid_points() -> tuple[Floats, Floats]:
    """Places (g, 2) of unit variance, and what each weighs (g,)."""
    line = np.linspace(-GRID_HALF_WIDTH, GRID_HALF_WIDTH, GRID_POINTS)
    weights = np.exp(-0.5 * line**2)
    weights /= weights.sum()
    line /= math.sqrt(float(weights @ line**2))
    north, east = np.meshgrid(line, line, indexing="ij")
    return np.column_stack((north.ravel(), east.ravel())), np.outer(weights, weights).ravel()


@dataclass(frozen=True)
class WallSegments:
    """Segments of one unit's path, between knots that join."""

    grid: FloorGrid
    knot: Ints  # (p,) behind which each begins
    since_m: Floats  # (p, 2) own path from the knot to its middle
    segment: Ints  # (s,) of each step, in order
    from_m: Floats  # (s, 2) own path from the piece's middle to the step's ends
    to_m: Floats
    floor: Ints  # (s,)
    climbs: NDArray[np.bool_]  # (s,)
    log_beside: Floats  # (s,) log likelihood of each step beside a wall

    @staticmethod
    def of(chain: Chain, grid: FloorGrid) -> WallSegments:
        path = chain.path
        rows = np.arange(1, len(path))
        floors = _floors(grid, path.down_m)[1:]
        steps = np.diff(path.own_m, axis=0)
        way = np.hypot(steps[:, 0], steps[:, 1])
        joins = (path.flags[1:] & (BREAK | RESTART)) == 0
        known = np.isin(floors, [floor for floor in set(floors.tolist()) if grid.has_floor(floor)])
        use = joins & known & (way < UNSEEN_M) & (way > 0.05)
        knot = np.searchsorted(chain.knots, rows, side="left") - 1  # of the step's interval
        knots, segment = np.unique(knot[use], return_inverse=True)
        middles = 0.5 * (chain.own_m[knots] + chain.own_m[np.minimum(knots + 1, len(chain) - 1)])
        rise = np.abs(np.diff(path.down_m))
        return WallSegments(
            grid=grid,
            knot=knots,
            since_m=middles - chain.own_m[knots],
            segment=segment,
            from_m=path.own_m[:-1][use] - middles[segment],
            to_m=path.own_m[1:][use] - middles[segment],
            floor=floors[use],
            climbs=(rise > CLIMBS * way)[use],
            log_beside=log_beside_wall(chain.place_var_m2[use]),
        )

    def __len__(self) -> int:
        return len(self.knot)

    def logs_at(self, estimate: PathEstimate, place_m: Floats) -> tuple[Floats, Floats]:
        """Log likelihoods of each segment at places of its middle (p, g, 2): by walls and stairs,
        and by the room beside walls.
        """
        turn = estimate.x[self.knot, 2:4][self.segment]
        from_m, to_m = _turned(turn, self.from_m), _turned(turn, self.to_m)
        logs, room = np.zeros((2, *place_m.shape[:2]))
        for floor in np.unique(self.floor).tolist():
            on = np.flatnonzero(self.floor == floor)
            middles = place_m[self.segment[on]]
            met = self.grid.crossings_shifted(floor, from_m[on], to_m[on], middles)
            logs += math.log(THROUGH_WALL) * self._steps_of(on, met == WALL)
            logs += math.log(OFF_FLOOR) * self._steps_of(on, met == OUTSIDE)
            room += self._steps_of(on, self.log_beside[on, None] * (met == BESIDE))
            up = on[self.climbs[on]]
            if len(up) and self.grid.has_stairs(floor):
                ends = (place_m[self.segment[up]] + to_m[up][:, None]).reshape(-1, 2)
                off = ~self.grid.on_stairs(floor, ends).reshape(len(up), -1)
                logs += math.log(OFF_STAIRS) * self._steps_of(up, off)
        return logs, room

    def _steps_of(self, steps: Ints, values: Floats | NDArray[np.bool_]) -> Floats:
        """Sums (p, g) of values or flags (n, g) over each segment's ``steps`` (n,)."""
        segments, first = np.unique(self.segment[steps], return_index=True)
        sums = np.zeros((len(self), values.shape[1]))
        sums[segments] = np.add.reduceat(values, first, axis=0, dtype=np.float64)
        return sums


class WallMessages:
    """Message of each segment about the place of its middle on the plan, in information form."""

    def __init__(self, segments: WallSegments) -> None:
        self.segments = segments
        self.log_loss = 0.0  # log weight a piece: how much walls stood in the way
        self.is_known = np.zeros(len(segments), dtype=np.bool_)  # well enough for a message
        self._information = np.zeros((len(segments), 2, 2))
        self._information_places = np.zeros((len(segments), 2))  # information times place

    def update(self, estimate: PathEstimate, off_m: Floats, spreads: Floats) -> None:
        """``off_m`` (2,): how far the plan lies off; ``spreads`` (k, 5, 5): of the knots as they
        lie on the plan.
        """
        rest, information_places = self._without(estimate, off_m, spreads)
        spread = np.linalg.inv(rest)
        self.is_known = np.linalg.eigvalsh(spread)[:, 1] < KNOWN_STD_M**2
        place = _times(spread, information_places)
        looks, weights = _grid_points()
        apart = looks @ np.linalg.cholesky(spread).transpose(0, 2, 1)
        logs, room = self.segments.logs_at(estimate, place[:, None] + apart)
        likely = weights * np.exp(logs)
        passed = likely.sum(axis=1)
        likely *= np.exp(room)
        likely /= likely.sum(axis=1)[:, None]
        shift = (likely[:, None] @ apart)[:, 0]
        off = apart - shift[:, None]
        left = (likely[:, :, None] * off).transpose(0, 2, 1) @ off + SHARPEST_M**2 * np.eye(2)
        information = _positive_part(np.linalg.inv(left) - rest)
        now = _times(rest + information, place + shift) - information_places
        information[~self.is_known], now[~self.is_known] = 0.0, 0.0
        self._information += DAMPING * (information - self._information)
        self._information_places += DAMPING * (now - self._information_places)
        self.log_loss = float(-np.where(self.is_known, np.log(passed), 0.0).mean())

    def _without(
        self, estimate: PathEstimate, off_m: Floats, spreads: Floats
    ) -> tuple[Floats, Floats]:
        """Estimate of each middle without its own message (cavity): information (p, 2, 2), and
        information times place (p, 2).
        """
        segments = self.segments
        to_place = np.zeros((len(segments), 2, STATES))
        north, east = segments.since_m.T
        to_place[:, 0, 0] = to_place[:, 1, 1] = 1.0
        to_place[:, 0, 2], to_place[:, 0, 3] = north, -east
        to_place[:, 1, 2], to_place[:, 1, 3] = east, north
        place = place_of(estimate.x[segments.knot], segments.since_m) + off_m
        whole = np.linalg.inv(to_place @ spreads[segments.knot] @ to_place.transpose(0, 2, 1))
        rest = whole - self._information
        # Numbers too near each other to be distinguished: the message is as good as all there is.
        lost = np.linalg.eigvalsh(rest)[:, 0] < LEAST_PART * np.linalg.eigvalsh(whole)[:, 0]
        rest[lost] = whole[lost]
        return rest, _times(whole, place) - np.where(lost[:, None], 0.0, self._information_places)

    def add(self, equations: Equations, base: int, plan: int) -> None:
        """``plan``: the column by which the plan lies north of where it should."""
        values, vectors = np.linalg.eigh(self._information)
        north, east = self.segments.since_m.T
        columns = base + STATES * self.segments.knot
        for one in (0, 1):
            used = values[:, one] > 1e-3
            if not used.any():
                continue
            to_n, to_e = vectors[used, 0, one], vectors[used, 1, one]
            value = values[used, one]
            right = (
                to_n * self._information_places[used, 0] + to_e * self._information_places[used, 1]
            ) / value
            n, e, column = north[used], east[used], columns[used]
            shared = np.full(len(column), plan)
            equations.add(
                1.0 / np.sqrt(value), right,
                (column, to_n), (column + 1, to_e),
                (column + 2, to_n * n + to_e * e), (column + 3, to_e * n - to_n * e),
                (shared, to_n), (shared + 1, to_e),
            )  # fmt: skip


def _floors(grid: FloorGrid, down_m: Floats) -> Ints:
    """Storey by storey of the plan, -1 where it has none."""
    floors, held = [], None
    for height_m in down_m.tolist():
        held = grid.plan.floor_at(height_m, held)
        floors.append(-(2**31) if held is None else held)
    return np.array(floors, dtype=np.int64)


def _turned(turn: Floats, vectors: Floats) -> Floats:
    c, s = turn.T
    return np.column_stack(
        (c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1])
    )


def _times(matrices: NDArray[Any], vectors: Floats) -> Floats:
    """(p, n, n) and (p, n): (p, n)."""
    return np.asarray((matrices @ vectors[:, :, None])[:, :, 0])


def _positive_part(information: Floats) -> Floats:
    """Without what would make a place less sure."""
    values, vectors = np.linalg.eigh(information)
    return np.asarray((vectors * np.maximum(values, 0.0)[:, None]) @ vectors.transpose(0, 2, 1))
