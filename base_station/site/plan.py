"""The building's plan as far as the station itself uses it: storeys, outlines, walls and stairs.

A plan is GeoJSON in site metres: coordinates are ``[east_m, north_m]`` in the incident frame,
and the member ``muster`` says so and lists the storeys::

    {"type": "FeatureCollection",
     "muster": {"frame": "site-m", "floors": [{"floor": 0, "down_m": 0.0},
                                              {"floor": 1, "down_m": -3.2}]},
     "features": [{"type": "Feature", "properties": {"kind": "outline", "floor": 0}, ...}]}

A feature of kind ``wall`` is a line that nobody walks through (doors are its gaps), one of kind
``stairs`` the ring within which people change floor.  Of several parts, each is one.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import Annotated, Any, TypeVar

import msgspec

from base_station.site.storeys import Storey, floor_at, sureness
from shared.errors import UserError

LEAST_POINTS = 2  # of a line
MOST_M = 100_000.0  # from the origin
MOST_FLOORS = 1000  # above or below
OUTLINE_HYSTERESIS_M = 1.5

Ring = tuple[tuple[float, float], ...]  # (east_m, north_m)
Read = TypeVar("Read")


class Wall(msgspec.Struct, frozen=True, array_like=True):
    floor: int
    line: Ring  # not closed


class Stairs(msgspec.Struct, frozen=True, array_like=True):
    floor: int
    ring: Ring


class Plan(msgspec.Struct, frozen=True):
    """What is left of a plan once it was understood; ``geojson`` is what the console draws."""

    geojson: bytes
    storeys: tuple[Storey, ...]  # by height, lowest first
    outlines: tuple[Ring, ...]
    walls: tuple[Wall, ...] = ()
    stairs: tuple[Stairs, ...] = ()

    @property
    def storeys_down_m(self) -> tuple[float, ...]:
        return tuple(storey.down_m for storey in self.storeys)

    def sureness(self, floor: int, down_m: float, std_down_m: float) -> float:
        """The probability of a floor, of all that the plan has."""
        return sureness(self.storeys, floor, down_m, std_down_m)

    def floor_at(self, down_m: float, floor: int | None) -> int | None:
        """The nearest storey's number, staying on ``floor`` until another is clearly nearer."""
        return floor_at(self.storeys, down_m, floor)

    def is_inside(self, north_m: float, east_m: float, inside: bool) -> bool:
        """Whether a place is in the building; near a wall, as it was before."""
        depth_m = self.depth_m(north_m, east_m)
        return depth_m > (-OUTLINE_HYSTERESIS_M if inside else OUTLINE_HYSTERESIS_M)

    def depth_m(self, north_m: float, east_m: float) -> float:
        """How far within the outer walls, negative outside of them; 0 where there is no outline."""
        return max((_depth_m(ring, east_m, north_m) for ring in self.outlines), default=0.0)

    def away_m(self, north_m: float, east_m: float) -> float:
        """How far from the nearest outline a place is; 0 within one or where there is none."""
        return max(
            0.0, min((-_depth_m(ring, east_m, north_m) for ring in self.outlines), default=0.0)
        )


def read_plan(geojson: bytes) -> Plan:
    """Raises UserError, which says what a plan must look like."""
    document = _document(geojson)
    outlines: list[Ring] = []
    walls: list[Wall] = []
    stairs: list[Stairs] = []
    features = _read(document.get("features", ()), list[_Feature], "feature")
    for number, feature in enumerate(features):
        about = feature.properties or {}
        kind = about.get("kind")
        if kind in _KINDS:
            lines = _lines(feature, f"{kind} (feature {number})")
            floor = _read(about.get("floor", 0), _Number, f"floor of a {kind} (feature {number})")
            if kind == "outline":
                outlines += lines
            elif kind == "wall":
                walls += [Wall(floor, line) for line in lines]
            else:
                stairs += [Stairs(floor, line) for line in lines]
    return Plan(geojson, _storeys(document["muster"]), tuple(outlines), tuple(walls), tuple(stairs))


def require_floors(plan: Plan) -> None:
    """UserError where walls or stairs are drawn on a floor whose height nobody says: nobody can be
    known to be there, so nobody would heed them.
    """
    listed = {storey.floor for storey in plan.storeys}
    drawn = {wall.floor for wall in plan.walls} | {one.floor for one in plan.stairs}
    if missing := sorted(drawn - listed):
        raise UserError(
            f"the plan has walls or stairs on floor {missing[0]} and says not how high that is: "
            f'"floors" of its member "muster" must list {{"floor": {missing[0]}, "down_m": ...}}'
        )


_KINDS = ("outline", "wall", "stairs")


_Number = Annotated[int, msgspec.Meta(ge=-MOST_FLOORS, le=MOST_FLOORS)]
_Metres = Annotated[float, msgspec.Meta(ge=-MOST_M, le=MOST_M)]


class _Floor(msgspec.Struct):
    floor: _Number
    down_m: _Metres


class _Geometry(msgspec.Struct):
    type: str
    coordinates: Any


class _Feature(msgspec.Struct):
    properties: dict[str, Any] | None = None
    geometry: Any = None  # only what the station uses is looked at


def _read(value: object, kind: type[Read], what: str) -> Read:
    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise UserError(f"the plan has a {what} that cannot be read: {error}") from error


def _document(geojson: bytes) -> dict[str, Any]:
    try:
        document = msgspec.json.decode(geojson)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UserError(f"the plan is no JSON: {error}") from error
    if not isinstance(document, dict) or document.get("type") != "FeatureCollection":
        raise UserError("the plan is no GeoJSON FeatureCollection")
    site = document.get("muster")
    if not isinstance(site, dict) or site.get("frame") != "site-m":
        raise UserError(
            'the plan has no scale: its member "muster" must say {"frame": "site-m", ...}, and '
            "coordinates must be [east_m, north_m] in metres"
        )
    return document


def _storeys(site: dict[str, Any]) -> tuple[Storey, ...]:
    """Lowest first."""
    listed = _read(site.get("floors", ()), list[_Floor], "list of floors")
    numbers = Counter(one.floor for one in listed)
    twice = [floor for floor, count in numbers.items() if count > 1]
    if twice:
        raise UserError(f"the plan lists floor {twice[0]} more than once")
    lowest_first = sorted(listed, key=lambda one: -one.down_m)
    return tuple(Storey(one.floor, one.down_m) for one in lowest_first)


def _lines(feature: _Feature, what: str) -> list[Ring]:
    """The points of each of its lines, or of its polygons' outer rings; a height beside a point is
    left.
    """
    geometry = _read(feature.geometry, _Geometry, what)
    is_multi = geometry.type.startswith("Multi")
    parts = _read(geometry.coordinates, list[Any], what) if is_multi else [geometry.coordinates]
    if not geometry.type.endswith("LineString"):
        parts = [part[0] if isinstance(part, list) and part else part for part in parts]
    lines = [_read(part, list[tuple[_Metres, ...]], what) for part in parts]
    points = [point for line in lines for point in line]
    if min(map(len, lines), default=0) < LEAST_POINTS or any(len(point) < 2 for point in points):
        raise UserError(f"the plan's {what} has fewer than two points [east_m, north_m]")
    return [tuple((point[0], point[1]) for point in line) for line in lines]


def _depth_m(ring: Ring, x_m: float, y_m: float) -> float:
    """Distance to the ring's border, negative outside of it."""
    inside = False
    nearest_m = math.inf
    for (x0_m, y0_m), (x1_m, y1_m) in zip(ring, ring[1:] + ring[:1], strict=True):
        if (y0_m > y_m) != (y1_m > y_m):
            inside ^= x_m < x0_m + (y_m - y0_m) * (x1_m - x0_m) / (y1_m - y0_m)
        from_start_m = complex(x_m - x0_m, y_m - y0_m)
        nearest_m = min(nearest_m, _to_segment_m(from_start_m, complex(x1_m - x0_m, y1_m - y0_m)))
    return nearest_m if inside else -nearest_m


def _to_segment_m(point_m: complex, segment_m: complex) -> float:
    """Distance of a point to a segment from the origin, both as east + north * i."""
    length2_m2 = abs(segment_m) ** 2
    if length2_m2 == 0.0:
        return abs(point_m)
    part = (point_m * segment_m.conjugate()).real / length2_m2
    return abs(point_m - min(1.0, max(0.0, part)) * segment_m)
