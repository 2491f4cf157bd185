"""The building's plan as far as the station itself uses it: storeys, outlines, walls and stairs.

A plan is GeoJSON in site metres: coordinates are ``[east_m, north_m]`` in the incident frame,
and the member ``muster`` says so and lists the storeys::

    {"type": "FeatureCollection",
     "muster": {"frame": "site-m", "floors": [{"floor": 0, "down_m": 0.0},
                                              {"floor": 1, "down_m": -3.2}]},
     "features": [{"type": "Feature", "properties": {"kind": "outline", "floor": 0}, ...}]}

A feature of kind ``wall`` is a line that nobody walks through (doors are its gaps), one of kind
``stairs`` the ring within which people change floor.
"""

from __future__ import annotations

import math
from typing import Any

import msgspec

from base_station.site.storeys import Storey, floor_at, sureness
from shared.errors import UserError

LEAST_POINTS = 2  # of a line
OUTLINE_HYSTERESIS_M = 1.5

Ring = tuple[tuple[float, float], ...]  # (east_m, north_m)


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
    try:
        document = msgspec.json.decode(geojson)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise UserError(f"the plan is no JSON: {error}") from error
    if not isinstance(document, dict) or document.get("type") != "FeatureCollection":
        raise UserError("the plan is no GeoJSON FeatureCollection")
    site = document.get("muster")
    if not isinstance(site, dict) or site.get("frame") != "site-m":
        raise UserError(
            'the plan has no scale: its member "muster" must say {"frame": "site-m", ...}, and '
            "coordinates must be [east_m, north_m] in metres"
        )
    try:
        storeys = sorted(
            (Storey(int(item["floor"]), float(item["down_m"])) for item in site.get("floors", ())),
            key=lambda storey: -storey.down_m,
        )
        features = [(item["properties"], item) for item in document.get("features", ())]
        outlines = tuple(_line(item) for about, item in features if about.get("kind") == "outline")
        walls = tuple(
            Wall(int(about.get("floor", 0)), _line(item))
            for about, item in features
            if about.get("kind") == "wall"
        )
        stairs = tuple(
            Stairs(int(about.get("floor", 0)), _line(item))
            for about, item in features
            if about.get("kind") == "stairs"
        )
    except (AttributeError, KeyError, TypeError, ValueError, IndexError) as error:
        raise UserError(
            f"the plan has a storey, outline, wall or stairs that cannot be read: {error!r}"
        ) from error
    if not all(math.isfinite(storey.down_m) for storey in storeys):
        raise UserError("the plan has a storey whose height is no number")
    lines = (*outlines, *(wall.line for wall in walls), *(one.ring for one in stairs))
    if not all(math.isfinite(value) for line in lines for point in line for value in point):
        raise UserError("the plan has a coordinate that is no number")
    if any(len(line) < LEAST_POINTS for line in lines):
        raise UserError("the plan has an outline, wall or stairs of fewer than two points")
    return Plan(geojson, tuple(storeys), outlines, walls, stairs)


def _line(feature: Any) -> Ring:
    """The points of a line, or of a polygon's outer ring."""
    geometry = feature["geometry"]
    points = geometry["coordinates"]
    outer = points if geometry["type"] == "LineString" else points[0]
    return tuple((float(point[0]), float(point[1])) for point in outer)


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
