"""Straight path segments along a building's walls, in two directions at right angles
(``building_model.straight_segments``).

A building's axis is what the segments of all units there show together; each segment then measures
its unit's heading, weighted by the probability that it follows a wall.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_model.stairs import SLOPE
from base_station.fusion.building_model.straight_segments import (
    ALONG_WALLS,
    QUARTER_RAD,
    SHOWN,
    TRIALS,
    Axis,
    SegmentDetector,
    StraightSegment,
    append_segment,
    evidence,
    wrap_quarter,
)
from base_station.fusion.odometry.points import BREAK, RESTART, PathArrays
from base_station.fusion.smoothing.chain import STATES, Chain, PathEstimate, place_of
from base_station.fusion.smoothing.equations import Equations

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

OUTSIDE_NS = 10_000_000_000  # so near a fix people are outside, where nothing is at right angles
UNSURE_RAD = 0.1  # of headings before an axis corrects them
TRIED_RAD = math.radians(1.0)
WALLS_STD_RAD = math.radians(1.5)  # walls of one building are not quite parallel
ASIDE_M = 0.4  # so far from the wall's direction leads one end of a leg from the other
UNLIKELY = 0.05
AXES = 4  # of the buildings in which most legs were walked
CELL_M = 12.5  # of ground; legs in cells that touch are of one building


@dataclass(frozen=True)
class PathSegments:
    """Straight segments of one unit, one row each."""

    knot: Ints
    direction_rad: Floats  # own frame
    length_m: Floats
    variance: Floats
    middle_knot: Ints  # before its middle
    since_m: Floats  # (n, 2) own path from that knot to the middle
    down_m: Floats  # of the middle
    climbs: NDArray[np.bool_]

    @staticmethod
    def of(chain: Chain) -> PathSegments:
        path, watch, is_inside = chain.path, SegmentDetector(), inside(chain.path)
        rows, found = [], []
        steps = np.diff(path.own_m, axis=0)
        for row, (north_m, east_m) in enumerate(steps.tolist(), start=1):
            if path.flags[row] & (BREAK | RESTART):
                watch = SegmentDetector()
                continue
            segment = watch.update(north_m, east_m)
            if segment is not None and is_inside[row]:
                rows.append(row - 1)
                variance = WALLS_STD_RAD**2 + (ASIDE_M / segment.length_m) ** 2
                found.append((segment.direction_rad, segment.length_m, variance))
        knot = np.searchsorted(chain.knots, np.array(rows, dtype=np.int64), side="right") - 1
        direction_rad, length_m, variances = np.array(found).reshape(-1, 3).T
        middles = _middles(chain, np.array(rows, dtype=np.int64), length_m)
        return PathSegments(knot, direction_rad, length_m, variances, *middles)

    def middles_m(self, estimate: PathEstimate) -> Floats:
        """Estimated middles (n, 2)."""
        return place_of(estimate.x[self.middle_knot], self.since_m)

    def turned_rad(self, estimate: PathEstimate) -> Floats:
        """Estimated directions in the incident frame."""
        turn = estimate.x[self.knot, 2:4]
        directions: Floats = np.arctan2(turn[:, 1], turn[:, 0]) + self.direction_rad
        return directions


def _middles(
    chain: Chain, rows: Ints, length_m: Floats
) -> tuple[Ints, Floats, Floats, NDArray[np.bool_]]:
    """Middles of segments that end at these rows: knot before the middle, own path from there (n,
    2), height (down), and a flag of climbs.
    """
    path = chain.path
    steps_m = np.hypot(*np.diff(path.own_m, axis=0).T) if len(path) > 1 else np.zeros(0)
    walked_m = np.concatenate(([0.0], np.cumsum(steps_m)))
    middle_m = walked_m[rows] - 0.5 * length_m
    own_m = np.column_stack([np.interp(middle_m, walked_m, axis) for axis in path.own_m.T])
    down_m = np.interp(middle_m, walked_m, path.down_m)
    rise_m = path.down_m[rows] - np.interp(walked_m[rows] - length_m, walked_m, path.down_m)
    before = np.maximum(np.searchsorted(walked_m, middle_m, side="right") - 1, 0)
    knot = np.searchsorted(chain.knots, before, side="right") - 1
    return knot, own_m - chain.own_m[knot], down_m, np.abs(rise_m) > SLOPE * length_m


class Axes:
    """Axes of the buildings in which segments were walked."""

    def __init__(
        self, segments: Mapping[str, PathSegments], estimates: Mapping[str, PathEstimate]
    ) -> None:
        """Assign segments to buildings by their estimated places."""
        self._segments = segments
        self.rad = np.full(AXES, np.nan)  # of each building, the estimate; NaN: none is found
        cells = {
            unit_id: np.rint(one.middles_m(estimates[unit_id]) / CELL_M).astype(np.int64)
            for unit_id, one in segments.items()
        }
        buildings = _buildings(np.concatenate(list(cells.values())))
        self.building = {  # of each leg; ``AXES``: none
            unit_id: np.array([buildings.get(cell, AXES) for cell in map(tuple, own.tolist())], int)
            for unit_id, own in cells.items()
        }

    @property
    def are_shown(self) -> bool:
        """In any building."""
        return bool(np.isfinite(self.rad).any())

    def of(self, unit_id: str) -> Floats:
        """The axis (n,) of each leg's building."""
        found: Floats = np.append(self.rad, np.nan)[self.building[unit_id]]
        return found

    def update(self, estimates: Mapping[str, PathEstimate]) -> None:
        """Find those that legs show by now."""
        for building in np.flatnonzero(np.isnan(self.rad)):
            turned = list[StraightSegment]()
            for unit_id, one in self._segments.items():
                is_aligned = estimates[unit_id].aligned[one.knot] & (
                    self.building[unit_id] == building
                )
                turned_rad = one.turned_rad(estimates[unit_id])[is_aligned]
                for direction_rad, length_m in zip(
                    turned_rad, one.length_m[is_aligned], strict=True
                ):
                    append_segment(turned, StraightSegment(float(direction_rad), float(length_m)))
            axis = Axis(_most(turned), UNSURE_RAD**2)
            if evidence(turned, axis) > SHOWN + TRIALS:
                self.rad[building] = axis.direction_rad


def _buildings(cells: Ints) -> dict[tuple[int, ...], int]:
    """Building of each cell of ground (n, 2), the one with most segments first."""
    segments = Counter(map(tuple, cells.tolist()))
    left, groups = dict(segments), []
    while left:
        group, edge = [], [left.popitem()[0]]
        while edge:
            north, east = cell = edge.pop()
            group.append(cell)
            beside = [(north + n, east + e) for n in (-1, 0, 1) for e in (-1, 0, 1)]
            edge += [one for one in beside if left.pop(one, None)]
        groups.append(group)
    groups.sort(key=lambda group: (-sum(segments[cell] for cell in group), min(group)))
    return {cell: row for row, group in enumerate(groups[:AXES]) for cell in group}


def _most(segments: Sequence[StraightSegment]) -> float:
    """The direction that most legs have or stand at right angles to."""
    if not segments:
        return 0.0
    turned_rad = np.array([segment.direction_rad for segment in segments])
    length_m = np.array([segment.length_m for segment in segments])
    tried_rad = np.arange(0.0, QUARTER_RAD, TRIED_RAD)
    most_rad = max(
        tried_rad.tolist(), key=lambda one: float(_near(turned_rad, length_m, one).sum())
    )
    near = _near(turned_rad, length_m, most_rad)
    return float(most_rad + near @ wrap_quarter(turned_rad - most_rad) / near.sum())


def _near(turned_rad: Floats, length_m: Floats, axis_rad: float) -> Floats:
    """The metres of each leg, by how near the axis it is; for one axis at a time, as all of them
    together are large.
    """
    near: Floats = length_m * np.exp(-0.5 * (wrap_quarter(turned_rad - axis_rad) / UNSURE_RAD) ** 2)
    return near


def add_segments(
    equations: Equations,
    base: int,
    segments: PathSegments,
    estimate: PathEstimate,
    axes: tuple[Floats, Ints],
) -> None:
    """Add heading constraints of segments along walls. ``axes``: estimated axis of each segment's
    building (NaN: none), and the column of its correction.
    """
    axis_rad, axis_columns = axes
    off = wrap_quarter(segments.turned_rad(estimate) - axis_rad)
    fits = np.exp(-0.5 * off**2 / segments.variance) / np.sqrt(math.tau * segments.variance)
    along = ALONG_WALLS * fits / (ALONG_WALLS * fits + (1.0 - ALONG_WALLS) / QUARTER_RAD)
    used = estimate.aligned[segments.knot] & (along > UNLIKELY)
    if not used.any():
        return
    columns = base + STATES * segments.knot[used]
    turn = estimate.x[segments.knot[used], 2:4]
    turns_rad = np.arctan2(turn[:, 1], turn[:, 0]) - off[used]
    equations.add(
        np.sqrt(segments.variance[used] / along[used]), 0.0,
        (columns + 2, -np.sin(turns_rad)), (columns + 3, np.cos(turns_rad)),
        (axis_columns[used], -1.0),
    )  # fmt: skip


def inside(path: PathArrays) -> NDArray[np.bool_]:
    """Points that are far from every fix."""
    if not len(path.fix_t_ns):
        return np.ones(len(path), dtype=bool)
    after = np.searchsorted(path.fix_t_ns, path.t_ns).clip(0, len(path.fix_t_ns) - 1)
    before = np.maximum(after - 1, 0)
    gaps_ns = [np.abs(path.fix_t_ns[one] - path.t_ns) for one in (before, after)]
    far: NDArray[np.bool_] = np.minimum(*gaps_ns) > OUTSIDE_NS
    return far
