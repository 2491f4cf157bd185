"""Live estimates as constraints, where they are more certain than the graph.

The graph has the whole past and future; a live estimate can be more certain only by the building
model or the walls of a plan. Of a plan's walls it is a first guess until ``wall_constraints`` use
them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.chain import (
    NS_TO_S,
    STATES,
    Chain,
    PathEstimate,
    place_of,
)
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.smoothing.interface import PositionConstraint
from base_station.fusion.smoothing.path_equations import add_places

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SURER = 0.7  # standard deviations, of the live estimate by the graph's
GATE2 = 9.0
EVERY_S = 10.0  # one is taken this often
WANDER_S = 60.0  # and they err alike for so long
TAIL = 2.4  # standard deviations from which one counts less


def choose_shown(
    chain: Chain, estimate: PathEstimate, spreads: Floats, places: Sequence[PositionConstraint]
) -> Ints:
    """Rows of the path where the live estimate knew better than the graph does, and contradicts
    neither the graph nor a place that is used.
    """
    path = chain.path
    knot = np.minimum(np.searchsorted(chain.knots, np.arange(len(path))), len(chain) - 1)
    near = knot - (chain.knots[knot] > np.arange(len(path)))
    apart = path.shown_m - place_of(estimate.x[near], path.own_m - chain.own_m[near])
    std = np.sqrt(np.trace(spreads[:, :2, :2], axis1=1, axis2=2) / 2.0)[knot]
    known = (path.shown_std_m > 0.0) & (path.shown_std_m < SURER * std)
    agrees = (apart**2).sum(axis=1) < GATE2 * (std**2 + path.shown_std_m**2)
    rows: list[int] = []
    for row in np.flatnonzero(known & agrees & ~_contradicted(path, places)):
        if not rows or (path.t_ns[row] - path.t_ns[rows[-1]]) * NS_TO_S >= EVERY_S:
            rows.append(int(row))
    return np.array(rows, dtype=np.int64)


def _contradicted(path: PathArrays, places: Sequence[PositionConstraint]) -> NDArray[np.bool_]:
    """Points from which a place that contradicts the live estimate is not parted by a fix or by a
    place that agrees: walls held the wearer in the wrong room.
    """
    misled = np.zeros(len(path), dtype=bool)
    for place in places:
        row = int(np.searchsorted(path.t_ns, place.t_ns).clip(0, len(path) - 1))
        apart = path.shown_m[row] - (place.north_m, place.east_m)
        spread = place.std_m**2 + path.shown_std_m[row] ** 2
        if float(apart @ apart) < GATE2 * spread:
            continue
        parting = np.sort(
            np.concatenate((path.fix_t_ns, [other.t_ns for other in places if other is not place]))
        )
        after = int(np.searchsorted(parting, place.t_ns, side="right"))
        begin = parting[after - 1] if after > 0 else -np.inf
        end = parting[after] if after < len(parting) else np.inf
        misled |= (path.t_ns >= begin) & (path.t_ns <= end)
    return misled


def add_shown(
    equations: Equations, base: int, chain: Chain, estimate: PathEstimate, rows: Ints
) -> None:
    """Add live estimates as constraints; their errors last, so that many count as few."""
    if not len(rows):
        return
    path = chain.path
    knot, since = chain.at(path.t_ns[rows])
    apart = np.linalg.norm(place_of(estimate.x[knot], since) - path.shown_m[rows], axis=1)
    std = path.shown_std_m[rows]
    tail = np.sqrt(1.0 + (apart / (TAIL * std)) ** 2) if estimate.aligned.any() else 1.0
    repeats = np.sqrt(2.0 * WANDER_S / EVERY_S)
    add_places(equations, base + STATES * knot, since, path.shown_m[rows], std * repeats * tail)


def shown_floor_m(path: PathArrays, rows: Ints | None) -> Floats:
    """Lower bound of the deviation, point by point, where the path rests on live estimates: a plan
    drawn half a metre off is off all the time.
    """
    if rows is None or not len(rows):
        return np.zeros(len(path))
    after = np.searchsorted(path.t_ns[rows], path.t_ns).clip(0, len(rows) - 1)
    before = np.maximum(after - 1, 0)
    gaps_s = [np.abs(path.t_ns - path.t_ns[rows[one]]) * NS_TO_S for one in (before, after)]
    near = np.minimum(*gaps_s) <= 2.0 * EVERY_S
    return np.where(near, path.shown_std_m, 0.0)
