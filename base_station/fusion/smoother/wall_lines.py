"""The same lines again, on all paths of an incident: corridors, and walls that people keep to.

Somebody who follows a building's walls walks where others do, and where they did before: a storey
has few corridors, and its rooms end at few walls.  How far across the axis legs lie gathers at such
lines; the most frequented are a mixture of normal distributions, and the rest of the legs lie
anywhere (expectation maximisation: Dempster, Laird and Rubin 1977).  Each line is an unknown of the
one problem, and a leg counts as far as it is one of that line; but one person's legs are aside of
it alike in part, to the hand that is on the wall, and many of them tell little more than a few.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.learnt.building import SURE_M
from base_station.fusion.learnt.legs import QUARTER_RAD
from base_station.fusion.smoother.chain import STATES, Belief, place_of
from base_station.fusion.smoother.equations import Equations
from base_station.fusion.smoother.landmarks import Visit
from base_station.fusion.smoother.legs import Axes, Legs

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ASIDE_M = 0.4  # each leg of its line: a corridor is some two metres wide
HABIT_PART = 0.2  # of that variance one person's legs have in common
CROOKED_RAD = np.radians(12.0)  # from the axis: not along walls
LEVELS_M = 1.0  # apart: of two storeys, whose lines need not lie above each other
LEGS_LEAST = 5.0  # a line is walked at least so often
BUILDING_M = 15.0  # legs that are of no line lie within as much at least
ANYWHERE = 0.3  # part of the legs, before anything is known
ANYWHERE_LEAST = 0.05
UNLIKELY = 0.1  # that a leg is of a line: not heeded
TURNS = 15
CELL_M = 0.1


@dataclass(frozen=True)
class Line:
    building: int
    quarter: int  # 0: along the axis, 1: at right angles to it
    visits: Sequence[Visit]  # at the middles of legs
    counts: Floats  # (v,) what part of a leg that tells by itself each one is worth


@dataclass(frozen=True)
class _Gathered:
    """Legs of all units that go one way on one storey; ``across_m`` and its variance by leg."""

    visits: list[Visit]
    across_m: Floats
    variance_m2: Floats

    def lines(self, building: int, quarter: int) -> Iterator[Line]:
        likely = mixture(self.across_m, self.variance_m2)
        for each in likely.T:
            of_it = np.flatnonzero(each > UNLIKELY)
            if len(of_it) > 1:
                visits = [self.visits[one] for one in of_it]
                counts = counts_of([v.unit_id for v in visits], each[of_it])
                yield Line(building, quarter, visits, counts)


def find_lines(
    legs: Mapping[str, Legs],
    beliefs: Mapping[str, Belief],
    spreads: Mapping[str, Floats],
    axes: Axes,
) -> list[Line]:
    """``spreads`` (k, n, n) by unit: of the knots, without what all units err by together."""
    shown = np.flatnonzero(np.isfinite(axes.rad)).tolist()
    return [line for one in shown for line in _lines_in(one, legs, beliefs, spreads, axes)]


def _lines_in(
    building: int,
    legs: Mapping[str, Legs],
    beliefs: Mapping[str, Belief],
    spreads: Mapping[str, Floats],
    axes: Axes,
) -> Iterator[Line]:
    axis_rad = float(axes.rad[building])
    visits: list[Visit] = []
    columns: list[Floats] = []  # quarter, level, across and its variance
    for unit_id, own in legs.items():
        belief = beliefs[unit_id]
        turns = (own.turned_rad(belief) - axis_rad) / QUARTER_RAD
        crooked = np.abs(turns - np.rint(turns)) * QUARTER_RAD > CROOKED_RAD
        known = np.trace(spreads[unit_id][own.middle_knot, :2, :2], axis1=1, axis2=2) < SURE_M**2
        used = belief.aligned[own.middle_knot] & known & ~crooked & ~own.climbs
        used &= axes.building[unit_id] == building
        knot, since_m = own.middle_knot[used], own.since_m[used]
        quarter = np.rint(turns[used]) % 2.0
        across = _across(axis_rad + quarter * QUARTER_RAD)
        off_m = (across * place_of(belief.x[knot], since_m)).sum(axis=1)
        var_m2 = np.einsum("ni,nij,nj->n", across, spreads[unit_id][knot, :2, :2], across)
        visits += [Visit(unit_id, *one) for one in zip(knot.tolist(), since_m, strict=True)]
        columns.append(np.column_stack((quarter, own.down_m[used], off_m, var_m2)))
    yield from _lines_of(building, visits, np.concatenate(columns))


def _lines_of(building: int, visits: list[Visit], columns: Floats) -> Iterator[Line]:
    for quarter in (0, 1):
        here = np.flatnonzero(columns[:, 0] == quarter)
        here = here[np.argsort(columns[here, 1], kind="stable")]
        storeys = np.flatnonzero(np.diff(columns[here, 1]) > LEVELS_M) + 1
        for rows in np.split(here, storeys):
            of_them = [visits[row] for row in rows]
            yield from _Gathered(of_them, columns[rows, 2], columns[rows, 3]).lines(
                building, quarter
            )


def mixture(across_m: Floats, variance_m2: Floats) -> Floats:
    """How likely each leg is of each line that they gather at (n, k)."""
    if len(across_m) < LEGS_LEAST:
        return np.zeros((len(across_m), 0))
    spread_m2 = (variance_m2 + ASIDE_M**2)[:, None]
    line_m, span_m = _crowded(across_m, spread_m2), max(float(np.ptp(across_m)), BUILDING_M)
    part, anywhere = np.full(len(line_m), (1.0 - ANYWHERE) / len(line_m)), ANYWHERE
    likely = np.zeros((len(across_m), len(line_m)))
    for _ in range(TURNS):
        fits = part * _normal(across_m[:, None] - line_m, spread_m2)
        likely = fits / (fits.sum(axis=1) + anywhere / span_m)[:, None]
        walked = likely.sum(axis=0) >= LEGS_LEAST
        likely = likely[:, walked]
        if not walked.any():
            break
        weights = likely / spread_m2
        line_m = across_m @ weights / weights.sum(axis=0)
        part = likely.mean(axis=0)
        anywhere = max(1.0 - float(part.sum()), ANYWHERE_LEAST)
    return likely


def counts_of(unit_ids: Sequence[str], likely: Floats) -> Floats:
    """``Line.counts`` of legs that are so likely of a line: n of one person, whose errors have a
    part p in common, tell as much together as n / (1 + p (n - 1)) that have not.
    """
    _, unit = np.unique(unit_ids, return_inverse=True)
    legs = np.bincount(unit, weights=likely)[unit]
    return np.asarray(likely / (1.0 + HABIT_PART * np.maximum(legs - 1.0, 0.0)))


def _crowded(across_m: Floats, spread_m2: Floats) -> Floats:
    """Where legs lie more densely than on either side."""
    near = np.arange(-round(ASIDE_M / CELL_M) - 1, round(ASIDE_M / CELL_M) + 2)
    cells = np.unique(np.rint(across_m / CELL_M)[:, None] + near) * CELL_M
    density = _normal(across_m[:, None] - cells, spread_m2).sum(axis=0)
    behind, ahead = np.append(-np.inf, density[:-1]), np.append(density[1:], -np.inf)
    return np.asarray(cells[(density >= behind) & (density > ahead)])


def _normal(off_m: Floats, spread_m2: Floats) -> Floats:
    return np.asarray(np.exp(-0.5 * off_m**2 / spread_m2) / np.sqrt(2.0 * np.pi * spread_m2))


def _across(direction_rad: Floats) -> Floats:
    """Unit vectors (n, 2) at right angles."""
    return np.asarray(np.column_stack((-np.sin(direction_rad), np.cos(direction_rad))))


def add_line(
    equations: Equations,
    line: Line,
    column: int,
    axes: tuple[Floats, Ints],
    bases: Mapping[str, int],
    beliefs: Mapping[str, Belief],
) -> None:
    """``column``: of how far across the line lies; ``axes``: of buildings as they are believed, and
    the columns of what has to be added to them.
    """
    axis_rad, axis_column = (one[line.building] for one in axes)
    since_m = np.array([one.since_m for one in line.visits])
    x = np.array([beliefs[one.unit_id].x[one.knot] for one in line.visits])
    own = np.array([bases[one.unit_id] + STATES * one.knot for one in line.visits])
    to_north, to_east = _across(np.array([axis_rad + line.quarter * QUARTER_RAD]))[0].tolist()
    north, east = since_m.T
    place_m = place_of(x, since_m)
    middle_m = place_m.mean(axis=0)
    along_m = (place_m - middle_m) @ (to_east, -to_north)
    equations.add(
        ASIDE_M / np.sqrt(line.counts), float(middle_m @ (to_north, to_east)),
        (own, to_north), (own + 1, to_east),
        (own + 2, to_north * north + to_east * east), (own + 3, to_east * north - to_north * east),
        (np.full(len(own), axis_column), -along_m), (np.full(len(own), column), -1.0),
    )  # fmt: skip
