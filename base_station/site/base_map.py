"""Base map: place of a picture of the ground, by its world file.

A world file has six numbers: change of x and y a column and a row (in the order a, d, b, e), and x
and y of the middle of the upper left pixel (c, f).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import msgspec

from base_station.site.utm import lat_lon_of, zone_of
from shared.coded_text import Measure, coded
from shared.errors import ConfigError

DEGREES, WEB_MAPS = "EPSG:4326", "EPSG:3857"
GRIDS = (
    f"degrees of longitude and latitude ({DEGREES}), metres of the web's maps ({WEB_MAPS}), or "
    "metres of a UTM zone (EPSG:258 and the zone in Europe, else EPSG:326 and the zone, and 327 in "
    "the south)"
)
EARTH_M = 6_378_137.0  # of the sphere of EPSG:3857
SMALLEST_M, LARGEST_M = 20.0, 5000.0  # beyond it a straight picture of a round Earth is off
FURTHEST_LAT_DEG = 85.0

LatLon = tuple[float, float]


class Corners(msgspec.Struct, frozen=True):
    """Corners of a picture, degrees (WGS-84); between them it is linear."""

    upper_left: LatLon
    upper_right: LatLon
    lower_left: LatLon


def corners_of(world: Sequence[float], crs: str, width_px: int, height_px: int) -> Corners:
    """Corners by a world file.  Raises ConfigError if it is not valid."""
    lat_lon = _grid(crs)
    if len(world) != 6 or not all(math.isfinite(value) for value in world):
        raise ConfigError(coded("world-file-unfit", "a world file has six numbers, one a line"))
    a, d, b, e, c, f = world

    def at(column: float, row: float) -> LatLon:
        column, row = column - 0.5, row - 0.5
        return lat_lon(a * column + b * row + c, d * column + e * row + f)

    corners = Corners(at(0, 0), at(width_px, 0), at(0, height_px))
    lats = [corner[0] for corner in (corners.upper_left, corners.upper_right, corners.lower_left)]
    lons = [corner[1] for corner in (corners.upper_left, corners.upper_right, corners.lower_left)]
    on_earth = all(abs(lat) <= FURTHEST_LAT_DEG for lat in lats)
    if not (on_earth and all(abs(lon) <= 180.0 for lon in lons)):
        raise ConfigError(
            coded(
                "world-file-off-earth",
                "as {grid} the world file's numbers lie nowhere on the Earth",
                grid=crs,
            )
        )
    sides_m = [
        _apart_m(corners.upper_left, other) for other in (corners.upper_right, corners.lower_left)
    ]
    if not all(SMALLEST_M <= side_m <= LARGEST_M for side_m in sides_m):
        raise ConfigError(
            coded(
                "map-size-unfit",
                "the picture would be {wide_m} by {high_m} m large; from {smallest_m} to "
                "{largest_m} m make sense",
                wide_m=Measure(sides_m[0], f"{sides_m[0]:.0f}"),
                high_m=Measure(sides_m[1], f"{sides_m[1]:.0f}"),
                smallest_m=Measure(SMALLEST_M, f"{SMALLEST_M:.0f}"),
                largest_m=Measure(LARGEST_M, f"{LARGEST_M:.0f}"),
            )
        )
    if abs(a * e - b * d) < 1e-6 * math.hypot(a, d) * math.hypot(b, e):
        raise ConfigError(
            coded("world-file-makes-line", "the world file makes a line of the picture")
        )
    return corners


def _grid(crs: str) -> Callable[[float, float], LatLon]:
    """Function that converts x and y of a world file to degrees."""
    if crs == DEGREES:
        return lambda x, y: (y, x)
    if crs == WEB_MAPS:
        return _of_web_maps
    zone = zone_of(crs)
    if zone is None:
        raise ConfigError(
            coded(
                "world-file-grid",
                "{grid} is none of the grids that a world file can be in: {known}",
                grid=crs,
                known=GRIDS,
            )
        )
    return lambda x, y: lat_lon_of(zone, x, y)


def _of_web_maps(x_m: float, y_m: float) -> LatLon:
    lat_rad = math.atan(math.sinh(min(max(y_m / EARTH_M, -10.0), 10.0)))
    return math.degrees(lat_rad), math.degrees(x_m / EARTH_M)


def _apart_m(one: LatLon, other: LatLon) -> float:
    north = math.radians(other[0] - one[0])
    east = math.radians(other[1] - one[1]) * math.cos(math.radians(one[0]))
    return EARTH_M * math.hypot(north, east)
