"""Features of a plan by RFC 7946, and further conditions on them.

Types describe valid features, so that msgspec checks a plan of 11 MB in half a second and reports
the place of a fault.  A member whose name is not here is a foreign one, and is left.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

import msgspec

from shared.coded_text import Measure, coded
from shared.errors import UserError

LEAST_POINTS = 2  # of a line
LEAST_RING_POINTS = 4  # RFC 7946, 3.1.6: the last one is the first
MOST_M = 100_000.0  # from the origin
MOST_FLOORS = 1000  # above or below
LINED = ("outline", "wall", "stairs")  # kinds whose borders the station uses
DRAWN = (*LINED, "room")

Line = tuple[tuple[float, float], ...]  # (east_m, north_m)
Floor = Annotated[int, msgspec.Meta(ge=-MOST_FLOORS, le=MOST_FLOORS)]
Metres = Annotated[float, msgspec.Meta(ge=-MOST_M, le=MOST_M)]
_Position = Annotated[tuple[Metres, ...], msgspec.Meta(min_length=2)]
_Positions = list[_Position]


class _Geometry(msgspec.Struct, tag_field="type", gc=False):
    pass


class PointGeometry(_Geometry, tag="Point"):
    coordinates: _Position


class MultiPoint(_Geometry, tag="MultiPoint"):
    coordinates: _Positions


class LineString(_Geometry, tag="LineString"):
    coordinates: _Positions


class MultiLineString(_Geometry, tag="MultiLineString"):
    coordinates: list[_Positions]


class Polygon(_Geometry, tag="Polygon"):
    coordinates: list[_Positions]


class MultiPolygon(_Geometry, tag="MultiPolygon"):
    coordinates: list[list[_Positions]]


class GeometryCollection(_Geometry, tag="GeometryCollection"):
    geometries: list[Geometry]


Geometry = (
    PointGeometry
    | MultiPoint
    | LineString
    | MultiLineString
    | Polygon
    | MultiPolygon
    | GeometryCollection
)
_LINES, _AREAS = (LineString, MultiLineString), (Polygon, MultiPolygon)
_SHAPES = {"room": _AREAS, **dict.fromkeys(LINED, (*_LINES, *_AREAS))}


class _Properties(msgspec.Struct, gc=False):
    """Properties that the station or a console uses."""

    kind: Any = None
    floor: Any = None


class _Feature(msgspec.Struct, gc=False):
    geometry: Geometry | None
    properties: _Properties | None = None
    type: Any = None
    id: str | int | float | None = None


class PlanFeature(msgspec.Struct, frozen=True, gc=False):
    number: int  # in the plan, from 0
    kind: str
    floor: int  # of those kinds of which the station takes heed
    geometry: Geometry | None
    stated_floor: Any  # as in the file
    is_typed: bool  # as ``Feature``: else it is not drawn

    @property
    def name(self) -> str:
        return feature_name(self.number, self.kind)

    def lines(self) -> list[Line]:
        """Points of each line, or of the outer rings of its areas; heights are ignored."""
        match self.geometry:
            case LineString(coordinates):
                lines = [coordinates]
            case MultiLineString(lines):
                pass
            case Polygon(coordinates):
                lines = coordinates[:1]
            case MultiPolygon(coordinates):
                lines = [rings[0] for rings in coordinates]
            case _:
                lines = []
        return [tuple((at[0], at[1]) for at in line) for line in lines]


def read_feature(number: int, encoded: msgspec.Raw) -> PlanFeature:
    """Read a feature.  Raises UserError, which names the feature."""
    try:
        feature = msgspec.json.decode(encoded, type=_Feature)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UserError(
            coded(
                "plan-feature-unreadable",
                "the plan has a {feature} that cannot be read: {error}",
                feature=Measure(number, _what(number, encoded)),
                error=str(error),
            )
        ) from error
    properties = feature.properties or _Properties()
    kind = properties.kind if isinstance(properties.kind, str) else ""
    floor = _floor(properties.floor, number, kind) if kind in LINED else 0
    is_typed = feature.type == "Feature"
    read = PlanFeature(number, kind, floor, feature.geometry, properties.floor, is_typed)
    _require_shape(read)
    return read


def require_strict(feature: PlanFeature) -> None:
    """UserError for what an earlier plan may have and a new one may not: the station closes a ring
    by itself, and a console draws a feature without a valid floor on all floors.
    """
    _floor(feature.stated_floor, feature.number, feature.kind)
    for ring in _rings(feature.geometry):
        if len(ring) < LEAST_RING_POINTS or ring[0] != ring[-1]:
            raise UserError(
                coded(
                    "plan-ring-open",
                    "the plan's {feature} has a ring that is not closed: it must have at least "
                    "{least} points, and the last must be the first (RFC 7946)",
                    feature=Measure(feature.number, feature.name),
                    least=LEAST_RING_POINTS,
                )
            )


def feature_name(number: int, kind: str) -> str:
    return f"{kind} (feature {number})" if kind else f"feature {number}"


def _floor(value: Any, number: int, kind: str) -> int:
    try:
        return 0 if value is None else msgspec.convert(value, Floor)
    except msgspec.ValidationError as error:
        raise UserError(
            coded(
                "plan-floor-unreadable",
                "the plan has a floor of a {feature} that cannot be read: {error}",
                feature=Measure(number, f"{kind or 'feature'} (feature {number})"),
                error=str(error),
            )
        ) from error


def _require_shape(feature: PlanFeature) -> None:
    allowed = _SHAPES.get(feature.kind)
    if allowed is not None and not isinstance(feature.geometry, allowed):
        shape = "null" if feature.geometry is None else type(feature.geometry).__name__
        shapes = ", ".join(one.__name__ for one in allowed)
        raise UserError(
            coded(
                "plan-geometry-unfit",
                "the plan's {feature} has the geometry {shape}: it must be one of {shapes}",
                feature=Measure(feature.number, feature.name),
                shape=shape,
                shapes=shapes,
            )
        )
    for parts in _parts(feature.geometry):
        if min(map(len, parts), default=0) < LEAST_POINTS:
            raise UserError(
                coded(
                    "plan-points-too-few",
                    "the plan's {feature} has fewer than two points [east_m, north_m]",
                    feature=Measure(feature.number, feature.name),
                )
            )


def _parts(geometry: Geometry | None) -> Iterator[list[_Positions]]:
    """The points of a line, or the rings of an area, each as a list of positions."""
    match geometry:
        case LineString(coordinates):
            yield [coordinates]
        case MultiLineString(parts) | Polygon(parts):
            yield parts
        case MultiPolygon(areas):
            yield from areas or [[]]
        case GeometryCollection(geometries):
            for one in geometries:
                yield from _parts(one)
        case _:
            pass


def _rings(geometry: Geometry | None) -> Iterator[_Positions]:
    match geometry:
        case Polygon(rings):
            yield from rings
        case MultiPolygon(areas):
            for rings in areas:
                yield from rings
        case GeometryCollection(geometries):
            for one in geometries:
                yield from _rings(one)
        case _:
            pass


def _what(number: int, encoded: msgspec.Raw) -> str:
    """Name of a feature that cannot be read, if it has one."""
    kind: Any = None
    try:
        properties = msgspec.json.decode(encoded)["properties"]
        kind = properties.get("kind")
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        pass  # it is no feature at all
    return feature_name(number, kind if isinstance(kind, str) else "")
