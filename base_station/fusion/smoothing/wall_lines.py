"""Lines that many segments follow, on all paths of an incident: corridors, and walls that people
keep to.

A storey has few corridors, and its rooms end at few walls. The offsets of segments across the axis
gather at such lines: a mixture of normal distributions, with a uniform part for other segments
(expectation maximisation: Dempster, Laird and Rubin 1977). Each line is an unknown of the problem,
and a segment counts by its probability; but the segments of one person share a part of their offset
(the hand on the wall), so that many count as few.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_model.building import SURE_M
from base_station.fusion.building_model.straight_segments import QUARTER_RAD
from base_station.fusion.smoothing.chain import STATES, PathEstimate, place_of
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.smoothing.landmarks import Visit
from base_station.fusion.smoothing.segment_constraints import Axes, PathSegments

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ASIDE_M = 0.4  # each leg of its line: a corridor is some two metres wide
HABIT_PART = 0.2  # of that variance one person's legs have in common
CROOKED_RAD = np.radians(12.0)  # from the axis: not along walls
LEVELS_M = 1.0  # apart: of two storeys, whose lines need not lie above each other
MIN_SEGMENTS = 5.0  # a line is walked at least so often
BUILDING_M = 15.0  # legs that are of no line lie within as much at least
ANYWHERE = 0.3  # part of the legs, before anything is known
ANYWHERE_LEAST = 0.05
UNLIKELY = 0.1  # that a leg is of a line: not heeded
MAX_ITERATIONS = 15
CELL_M = 0.1
AT_ONCE = 1000  # legs: of all of them at all cells there are hundreds of megabytes


@dataclass(frozen=True)
class Line:
    building: int
    wrap_quarter: int  # 0: along the axis, 1: at right angles to it
    visits: Sequence[Visit]  # at the middles of legs
    counts: Floats  # (v,) weight of each, as a part of an independent leg


@dataclass(frozen=True)
class _Gathered:
    """Legs of all units that go one way on one storey; ``across_m`` and its variance by leg."""

    visits: list[Visit]
    across_m: Floats
    variance_m2: Floats

    def lines(self, building: int, wrap_quarter: int) -> Iterator[Line]:
        likely = mixture(self.across_m, self.variance_m2)
        for each in likely.T:
            of_it = np.flatnonzero(each > UNLIKELY)
            if len(of_it) > 1:
                visits = [self.visits[one] for one in of_it]
                counts = counts_of([v.unit_id for v in visits], each[of_it])
                yield Line(building, wrap_quarter, visits, counts)


def find_lines(
    segments: Mapping[str, PathSegments],
    estimates: Mapping[str, PathEstimate],
    spreads: Mapping[str, Floats],
    axes: Axes,
) -> list[Line]:
    """``spreads`` (k, n, n) by unit: of the knots, without what all units err by together."""
    shown = np.flatnonzero(np.isfinite(axes.rad)).tolist()
    return [line for one in shown for line in _lines_in(one, segments, estimates, spreads, axes)]


def _lines_in(
    building: int,
    segments: Mapping[str, PathSegments],
    estimates: Mapping[str, PathEstimate],
    spreads: Mapping[str, Floats],
    axes: Axes,
) -> Iterator[Line]:
    axis_rad = float(axes.rad[building])
    visits: list[Visit] = []
    columns: list[Floats] = []  # quarter, level, across and its variance
    for unit_id, own in segments.items():
        estimate, spread = estimates[unit_id], spreads[unit_id][:, :2, :2]
        turns = (own.turned_rad(estimate) - axis_rad) / QUARTER_RAD
        crooked = np.abs(turns - np.rint(turns)) * QUARTER_RAD > CROOKED_RAD
        known = np.trace(spread[own.middle_knot], axis1=1, axis2=2) < SURE_M**2
        used = estimate.aligned[own.middle_knot] & known & ~crooked & ~own.climbs
        used &= axes.building[unit_id] == building
        knot, since_m = own.middle_knot[used], own.since_m[used]
        wrap_quarter = np.rint(turns[used]) % 2.0
        across = _across(axis_rad + wrap_quarter * QUARTER_RAD)
        off_m = (across * place_of(estimate.x[knot], since_m)).sum(axis=1)
        var_m2 = np.einsum("ni,nij,nj->n", across, spread[knot], across)
        visits += [Visit(unit_id, *one) for one in zip(knot.tolist(), since_m, strict=True)]
        columns.append(np.column_stack((wrap_quarter, own.down_m[used], off_m, var_m2)))
    yield from _lines_of(building, visits, np.concatenate(columns))


def _lines_of(building: int, visits: list[Visit], columns: Floats) -> Iterator[Line]:
    for wrap_quarter in (0, 1):
        here = np.flatnonzero(columns[:, 0] == wrap_quarter)
        here = here[np.argsort(columns[here, 1], kind="stable")]
        storeys = np.flatnonzero(np.diff(columns[here, 1]) > LEVELS_M) + 1
        for rows in np.split(here, storeys):
            of_them = [visits[row] for row in rows]
            yield from _Gathered(of_them, columns[rows, 2], columns[rows, 3]).lines(
                building, wrap_quarter
            )


def mixture(across_m: Floats, variance_m2: Floats) -> Floats:
    """Probability of each segment for each line (n, k)."""
    if len(across_m) < MIN_SEGMENTS:
        return np.zeros((len(across_m), 0))
    spread_m2 = (variance_m2 + ASIDE_M**2)[:, None]
    line_m, span_m = _density_peaks(across_m, spread_m2), max(float(np.ptp(across_m)), BUILDING_M)
    part, anywhere = np.full(len(line_m), (1.0 - ANYWHERE) / len(line_m)), ANYWHERE
    likely = np.zeros((len(across_m), len(line_m)))
    for _ in range(MAX_ITERATIONS):
        likely = np.empty((len(across_m), len(line_m)))
        for some in _portions(len(across_m)):
            fits = part * _normal(across_m[some, None] - line_m, spread_m2[some])
            likely[some] = fits / (fits.sum(axis=1) + anywhere / span_m)[:, None]
        walked = likely.sum(axis=0) >= MIN_SEGMENTS
        likely = likely[:, walked]
        if not walked.any():
            break
        weight = 1.0 / spread_m2[:, 0]
        line_m = (across_m * weight) @ likely / (weight @ likely)
        part = likely.mean(axis=0)
        anywhere = max(1.0 - float(part.sum()), ANYWHERE_LEAST)
    return likely


def counts_of(unit_ids: Sequence[str], likely: Floats) -> Floats:
    """``Line.counts`` of segments with these probabilities: n of one person, whose errors share a
    part p, count as n / (1 + p (n - 1)).
    """
    _, unit = np.unique(unit_ids, return_inverse=True)
    segments = np.bincount(unit, weights=likely)[unit]
    return np.asarray(likely / (1.0 + HABIT_PART * np.maximum(segments - 1.0, 0.0)))


def _density_peaks(across_m: Floats, spread_m2: Floats) -> Floats:
    """Offsets where segments are denser than on either side."""
    near = np.arange(-round(ASIDE_M / CELL_M) - 1, round(ASIDE_M / CELL_M) + 2)
    cells = np.unique(np.rint(across_m / CELL_M)[:, None] + near) * CELL_M
    density = np.zeros(len(cells))
    for some in _portions(len(across_m)):
        density += _normal(across_m[some, None] - cells, spread_m2[some]).sum(axis=0)
    behind, ahead = np.append(-np.inf, density[:-1]), np.append(density[1:], -np.inf)
    return np.asarray(cells[(density >= behind) & (density > ahead)])


def _portions(count: int) -> Iterator[slice]:
    """Slices of so many segments."""
    return (slice(first, first + AT_ONCE) for first in range(0, count, AT_ONCE))


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
    estimates: Mapping[str, PathEstimate],
) -> None:
    """Add the equations of a line. ``column``: of its offset; ``axes``: estimated axes of
    buildings, and the columns of their corrections.
    """
    axis_rad, axis_column = (one[line.building] for one in axes)
    since_m = np.array([one.since_m for one in line.visits])
    x = np.array([estimates[one.unit_id].x[one.knot] for one in line.visits])
    own = np.array([bases[one.unit_id] + STATES * one.knot for one in line.visits])
    to_north, to_east = _across(np.array([axis_rad + line.wrap_quarter * QUARTER_RAD]))[0].tolist()
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
