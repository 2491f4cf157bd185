"""Horizontal sections of solids, by the library ``shapely``: what a floor's plan is drawn from.

Lengths are metres, in the frame of the file: x, y, and z up.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.drawings.shapes import Point

_GRID_M = 1e-4  # ends of segments that are one point
_SHEET_M = 0.04  # thickness of a surface that bounds no solid
_CLOSED_M = 0.05  # gaps of twice this between walls are joints, and no passages
_ROUGH_M = 0.02
_LEAST_M2 = 0.01  # of a piece of wall
_LEAST_INSIDE_M2 = 4.0  # that an outline encloses
MOST_OUTLINE_POINTS = 900  # of all floors


class Solid(NamedTuple):
    """Triangles of an element or of its parts."""

    vertices: NDArray[np.float64]  # (n, 3)
    triangles: NDArray[np.int64]  # (m, 3), rows of ``vertices``

    @property
    def bottom_m(self) -> float:
        return float(self.vertices[:, 2].min())

    @property
    def top_m(self) -> float:
        return float(self.vertices[:, 2].max())


class WallGap(NamedTuple):
    """Rectangle of an opening, in axes of which the first is along the wall."""

    along: Point  # unit vector
    begin_m: float
    end_m: float
    near_m: float  # across
    far_m: float

    def line(self) -> list[Point]:
        """Threshold from jamb to jamb."""
        middle_m = (self.near_m + self.far_m) / 2.0
        return [self._at(self.begin_m, middle_m), self._at(self.end_m, middle_m)]

    def area(self, beyond_m: float) -> Any:
        """Polygon of the opening, extended by the same depth beyond both faces of the wall."""
        near_m, far_m = self.near_m - beyond_m, self.far_m + beyond_m
        ends = ((self.begin_m, near_m), (self.end_m, near_m), (self.end_m, far_m))
        return _library().Polygon([self._at(*end) for end in (*ends, (self.begin_m, far_m))])

    def _at(self, along_m: float, across_m: float) -> Point:
        x, y = self.along
        return along_m * x - across_m * y, along_m * y + across_m * x


def joined(solids: Sequence[Solid]) -> Solid:
    """Join the solids of an element's parts into one."""
    first = np.cumsum([0, *(len(one.vertices) for one in solids[:-1])])
    triangles = [one.triangles + at for one, at in zip(solids, first, strict=True)]
    return Solid(np.concatenate([one.vertices for one in solids]), np.concatenate(triangles))


def section(solid: Solid, height_m: float) -> Any:
    """Area (shapely) in which a plane cuts a solid; empty if it does not."""
    shapely = _library()
    above = solid.vertices[:, 2] >= height_m
    count_above = above[solid.triangles].sum(axis=1)
    cut = solid.triangles[(count_above > 0) & (count_above < 3)]
    if not len(cut):
        return shapely.Polygon()
    # Of three vertices one lies alone on its side; both edges from it cross the plane.
    sides = above[cut]
    alone = np.argmax(sides == (sides.sum(axis=1) == 1)[:, None], axis=1)
    rows = np.arange(len(cut))
    tips = cut[rows, alone]
    ends = np.stack(
        [_crossing(solid.vertices, tips, cut[rows, (alone + by) % 3], height_m) for by in (1, 2)],
        axis=1,
    )
    ends = np.round(ends / _GRID_M) * _GRID_M
    segments = shapely.linestrings(ends[np.any(ends[:, 0] != ends[:, 1], axis=1)])
    lines = shapely.union_all(segments)
    area = shapely.build_area(lines)
    return lines.buffer(_SHEET_M / 2.0, cap_style="flat") if area.is_empty else area


def footprint(solid: Solid) -> Any:
    """Convex area (shapely) below a solid."""
    return _library().MultiPoint(solid.vertices[:, :2]).convex_hull


def gap_of(area: Any, along: Point) -> WallGap:
    """Rectangle around the section of an opening."""
    points = _library().get_coordinates(area)
    x, y = along
    begin_m, end_m = np.sort(points @ (x, y))[[0, -1]]
    near_m, far_m = np.sort(points @ (-y, x))[[0, -1]]
    return WallGap(along, float(begin_m), float(end_m), float(near_m), float(far_m))


def united_walls(areas: Sequence[Any]) -> Any:
    """Walls of a floor as one area, with the joints between them closed."""
    outer = _library().union_all(areas).buffer(_CLOSED_M, join_style="mitre")
    return outer.buffer(-_CLOSED_M, join_style="mitre")


def wall_lines(walls: Any, gaps: Sequence[Any]) -> list[list[Point]]:
    """Faces of the walls as closed lines, with the gaps cut out."""
    left = walls.difference(_library().union_all(gaps)).simplify(_ROUGH_M)
    return [
        _points(ring)
        for area in polygons(left)
        if area.area >= _LEAST_M2
        for ring in (area.exterior, *area.interiors)
    ]


def outlines_of(floors: Sequence[Any]) -> list[list[list[Point]]]:
    """Rings around the walls of each floor that enclose something, simplified as much as the limit
    of their points requires.
    """
    whole = [
        united([_filled(one) for one in polygons(walls) if _encloses(one)]) for walls in floors
    ]
    tolerance_m = 0.1
    while True:
        rings = [rings_of(areas, tolerance_m) for areas in whole]
        if sum(len(ring) for floor in rings for ring in floor) <= MOST_OUTLINE_POINTS:
            return rings
        tolerance_m *= 2.0


def rings_of(area: Any, tolerance_m: float = _ROUGH_M) -> list[list[Point]]:
    """Outer rings of an area, simplified."""
    return [_points(one.exterior) for one in polygons(area.simplify(tolerance_m))]


def united(areas: Sequence[Any]) -> Any:
    """Union of areas."""
    return _library().union_all(areas)


def polygons(area: Any) -> list[Any]:
    """Polygons that form an area."""
    parts = _library().get_parts(area)
    return [one for one in parts if one.geom_type == "Polygon" and not one.is_empty]


def _filled(area: Any) -> Any:
    return _library().Polygon(area.exterior)


def _encloses(area: Any) -> bool:
    return bool(_filled(area).area - area.area >= _LEAST_INSIDE_M2)


def _points(ring: Any) -> list[Point]:
    return [(float(x), float(y)) for x, y in ring.coords]


def _crossing(
    vertices: NDArray[np.float64], tips: NDArray[np.int64], others: NDArray[np.int64], at_m: float
) -> NDArray[np.float64]:
    """Points (n, 2) at which edges cross the plane; the same for both triangles of an edge."""
    first, second = vertices[np.minimum(tips, others)], vertices[np.maximum(tips, others)]
    part = (at_m - first[:, 2]) / (second[:, 2] - first[:, 2])
    crossing: NDArray[np.float64] = first[:, :2] + part[:, None] * (second[:, :2] - first[:, :2])
    return crossing


def _library() -> Any:
    return import_module("shapely")
