"""Where trails lead through the same narrow place again: the ends of stairs.

People change storeys only on stairs, and a building has few of them, so two trails that begin a
climb at the same height, nearer to each other than two staircases are, begin it at the same
place.  The links are weighed robustly: one that does not fit counts less and less.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoother.chain import Belief, Chain, place_of
from base_station.fusion.smoother.links import Link

Floats = NDArray[np.float64]

STOREY_M = 2.0  # a climb of at least this
LEVEL_M = 0.08  # from one point to the next: less is level ground
LANDING_POINTS = 5
SAME_LEVEL_M = 1.2
SURE_M = 6.0  # both ends are known at least this well, or it may be other stairs
GATE2 = 9.2  # chi-square of two degrees, 99 %
LINKS = 3  # of each end, to the nearest ones in the list before it
STD_M = 1.0
TAIL = 2.0


@dataclass(frozen=True)
class _End:
    unit_id: str
    t_ns: int
    place_m: Floats
    down_m: float
    is_top: bool
    spread_m2: Floats


def find_crossings(
    chains: Mapping[str, Chain], beliefs: Mapping[str, Belief], spreads: Mapping[str, Floats]
) -> list[Link]:
    ends: list[_End] = []
    for unit_id, chain in chains.items():
        path, belief = chain.path, beliefs[unit_id]
        for bottom, top in _climbs(path.down_m):
            for row, is_top in ((bottom, False), (top, True)):
                knot, since = chain.at(path.t_ns[row : row + 1])
                spread = spreads[unit_id][knot[0], :2, :2]
                if float(np.trace(spread)) < SURE_M**2 and belief.aligned[knot[0]]:
                    place = place_of(belief.x[knot], since)[0]
                    down_m = float(path.down_m[row])
                    ends.append(_End(unit_id, int(path.t_ns[row]), place, down_m, is_top, spread))
    crossings: list[Link] = []
    for number, end in enumerate(ends):
        alike = [other for other in ends[:number] if _may_be_same(end, other)]
        alike.sort(key=lambda other: float(np.linalg.norm(other.place_m - end.place_m)))
        crossings += [
            Link((end.unit_id, end.t_ns), (other.unit_id, other.t_ns), STD_M, TAIL)
            for other in alike[:LINKS]
        ]
    return crossings


def _climbs(down_m: Floats) -> list[tuple[int, int]]:
    """Rows at the bottom and at the top of every climb, whichever way it was walked; a landing is
    part of it.
    """
    rises = np.where(np.abs(np.diff(down_m)) > LEVEL_M, -np.sign(np.diff(down_m)), 0.0)
    climbs: list[tuple[int, int]] = []
    begin = end = -1
    for row in np.flatnonzero(rises):
        goes_on = begin >= 0 and row - end <= LANDING_POINTS and rises[row] == rises[begin]
        if not goes_on:
            if begin >= 0:
                climbs.append((begin, end))
            begin = int(row)
        end = int(row) + 1
    if begin >= 0:
        climbs.append((begin, end))
    return [
        (first, last) if rises[first] > 0.0 else (last, first)
        for first, last in climbs
        if abs(down_m[last] - down_m[first]) >= STOREY_M
    ]


def _may_be_same(one: _End, other: _End) -> bool:
    if one.is_top is not other.is_top or abs(one.down_m - other.down_m) > SAME_LEVEL_M:
        return False
    apart = one.place_m - other.place_m
    spread = one.spread_m2 + other.spread_m2 + STD_M**2 * np.eye(2)
    return float(apart @ np.linalg.solve(spread, apart)) < GATE2
