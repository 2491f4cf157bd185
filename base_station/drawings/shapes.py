"""Shapes that a drawing gives, and the plan that is made of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from shared.coded_text import Measure, coded
from shared.errors import UserError

STOREY_M = 3.2  # where the file does not have the height of a floor
MOST_POINTS = 200_000
MOST_SIZE_M = 5_000.0  # of a site
_LEAST_SIZE_M = 1.0

Point = tuple[float, float]


class DrawnShape(NamedTuple):
    kind: str  # of a plan: wall, outline, stairs, room or door
    floor: int
    points: Sequence[Point]  # east_m, north_m; a closed one ends where it begins
    name: str = ""


def plan_of(
    name: str, shapes: Sequence[DrawnShape], heights_m: Mapping[int, float] | None = None
) -> dict[str, Any]:
    """GeoJSON in site metres, as ``site/plan`` accepts it.  UserError if it is no building.

    ``heights_m``: heights of the floors above the ground floor; without them floors are
    ``STOREY_M`` apart.
    """
    if not shapes:
        raise UserError(coded("drawing-no-wall", "the drawing has no line that could be a wall"))
    require_size([point for shape in shapes for point in shape.points])
    if heights_m is None:
        heights_m = {shape.floor: shape.floor * STOREY_M for shape in shapes}
    return {
        "type": "FeatureCollection",
        "muster": {
            "frame": "site-m",
            "name": name,
            "floors": [
                {"floor": floor, "down_m": 0.0 - height_m}
                for floor, height_m in sorted(heights_m.items())
            ],
        },
        "features": [_feature(shape) for shape in shapes],
    }


def box_of(points: Iterable[Point]) -> tuple[float, float, float, float]:
    """Bounds: west, south, east, north."""
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def require_size(points: Sequence[Point]) -> None:
    """UserError if it is too small to walk in, or larger than any site."""
    if len(points) > MOST_POINTS:
        raise UserError(
            coded(
                "drawing-too-fine",
                "the drawing has more than {most} points; leave out furniture and hatching",
                most=MOST_POINTS,
            )
        )
    west, south, east, north = box_of(points)
    size_m = max(east - west, north - south)
    if not _LEAST_SIZE_M <= size_m <= MOST_SIZE_M:
        raise UserError(
            coded(
                "drawing-size-unfit",
                "the drawing is {wide_m} wide: choose another unit of length, or send one building",
                wide_m=Measure(size_m, f"{size_m:.4g} m"),
            )
        )


def _feature(shape: DrawnShape) -> dict[str, Any]:
    line = [[round(x, 3), round(y, 3)] for x, y in shape.points]
    is_area = shape.kind in {"outline", "stairs", "room"} and line[0] == line[-1] and len(line) > 3
    geometry = (
        {"type": "Polygon", "coordinates": [line]}
        if is_area
        else {"type": "LineString", "coordinates": line}
    )
    properties: dict[str, Any] = {"kind": shape.kind, "floor": shape.floor}
    if shape.name:
        properties["name"] = shape.name
    return {"type": "Feature", "properties": properties, "geometry": geometry}
