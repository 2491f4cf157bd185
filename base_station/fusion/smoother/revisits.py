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

from base_station.fusion.smoother.chain import Belief, Chain

Floats = NDArray[np.float64]

STOREY_M = 2.0  # a climb of at least this
LEVEL_M = 0.25  # per knot: less is level ground
SAME_LEVEL_M = 1.2
SURE_M = 6.0  # both ends are known at least this well, or it may be other stairs
GATE2 = 9.2  # chi-square of two degrees, 99 %
LINKS = 3  # of each end, to the nearest ones in the list before it
STD_M = 1.0


@dataclass(frozen=True)
class Crossing:
    """Two knots, each of a unit, that are the same place."""

    one: tuple[str, int]
    other: tuple[str, int]
    std_m: float


@dataclass(frozen=True)
class _End:
    unit_id: str
    knot: int
    place_m: Floats
    down_m: float
    is_top: bool
    spread_m2: Floats


def find_crossings(
    chains: Mapping[str, Chain], beliefs: Mapping[str, Belief], spreads: Mapping[str, Floats]
) -> list[Crossing]:
    ends: list[_End] = []
    for unit_id, chain in chains.items():
        down = chain.path.down_m[chain.knots]
        for bottom, top in _climbs(down):
            for knot, is_top in ((bottom, False), (top, True)):
                place, spread = beliefs[unit_id].x[knot, :2], spreads[unit_id][knot, :2, :2]
                if float(np.trace(spread)) < SURE_M**2 and beliefs[unit_id].aligned[knot]:
                    ends.append(_End(unit_id, knot, place, float(down[knot]), is_top, spread))
    crossings: list[Crossing] = []
    for number, end in enumerate(ends):
        alike = [other for other in ends[:number] if _may_be_same(end, other)]
        alike.sort(key=lambda other: float(np.linalg.norm(other.place_m - end.place_m)))
        crossings += [
            Crossing((end.unit_id, end.knot), (other.unit_id, other.knot), STD_M)
            for other in alike[:LINKS]
        ]
    return crossings


def _climbs(down_m: Floats) -> list[tuple[int, int]]:
    """Knots at the bottom and at the top of every climb, whichever way it was walked."""
    rises = np.where(np.abs(np.diff(down_m)) > LEVEL_M, -np.sign(np.diff(down_m)), 0.0)
    climbs, row = [], 0
    while row < len(rises):
        if rises[row] == 0.0:
            row += 1
            continue
        end = row
        while end < len(rises) and rises[end] == rises[row]:
            end += 1
        if abs(down_m[end] - down_m[row]) >= STOREY_M:
            climbs.append((row, end) if rises[row] > 0.0 else (end, row))
        row = end
    return climbs


def _may_be_same(one: _End, other: _End) -> bool:
    if one.is_top is not other.is_top or abs(one.down_m - other.down_m) > SAME_LEVEL_M:
        return False
    apart = one.place_m - other.place_m
    spread = one.spread_m2 + other.spread_m2 + STD_M**2 * np.eye(2)
    return float(apart @ np.linalg.solve(spread, apart)) < GATE2
