"""Positions of the UTM grid on the Earth, in which surveyors give aerial pictures.

Krüger's series for the inverse transverse Mercator projection, to the fourth order in the third
flattening (C. F. F. Karney, "Transverse Mercator with an accuracy of a few nanometers", J. Geodesy
85, 2011, equations 7 to 11 and 36). ETRS89 and WGS-84 are taken as the same: they differ by less
than a metre.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

_SEMI_MAJOR_M = 6_378_137.0
_FLATTENING = 1 / 298.257_223_563
_N = _FLATTENING / (2 - _FLATTENING)
_RECTIFYING_M = _SEMI_MAJOR_M / (1 + _N) * (1 + _N**2 / 4 + _N**4 / 64)
_SCALE = 0.9996
_FALSE_EAST_M, _FALSE_NORTH_M = 500_000.0, 10_000_000.0
_TO_SPHERE = (
    _N / 2 - 2 * _N**2 / 3 + 37 * _N**3 / 96 - _N**4 / 360,
    _N**2 / 48 + _N**3 / 15 - 437 * _N**4 / 1440,
    17 * _N**3 / 480 - 37 * _N**4 / 840,
    4397 * _N**4 / 161_280,
)
_TO_ELLIPSOID = (
    2 * _N - 2 * _N**2 / 3 - 2 * _N**3 + 116 * _N**4 / 45,
    7 * _N**2 / 3 - 8 * _N**3 / 5 - 227 * _N**4 / 45,
    56 * _N**3 / 15 - 136 * _N**4 / 35,
    4279 * _N**4 / 630,
)
_NAMES = re.compile(r"EPSG:(?P<grid>326|327|258)(?P<zone>\d\d)")


class Zone(NamedTuple):
    number: int  # 1..60, each of six degrees, from 180 degrees west
    is_south: bool


def zone_of(crs: str) -> Zone | None:
    """Zone of ``EPSG:326..`` (WGS-84, north), ``327..`` (south) and ``258..`` (ETRS89)."""
    found = _NAMES.fullmatch(crs)
    if found is None or not 1 <= int(found["zone"]) <= 60:
        return None
    return Zone(int(found["zone"]), found["grid"] == "327")


def lat_lon_of(zone: Zone, east_m: float, north_m: float) -> tuple[float, float]:
    """Latitude and longitude in degrees; nan for numbers that are no position of the zone."""
    north_m -= _FALSE_NORTH_M if zone.is_south else 0.0
    if not (abs(east_m - _FALSE_EAST_M) <= 1e6 and abs(north_m) <= _FALSE_NORTH_M):
        return math.nan, math.nan
    xi, eta = (
        north_m / (_SCALE * _RECTIFYING_M),
        (east_m - _FALSE_EAST_M) / (_SCALE * _RECTIFYING_M),
    )
    along, across = xi, eta
    for twice, factor in zip((2, 4, 6, 8), _TO_SPHERE, strict=True):
        along -= factor * math.sin(twice * xi) * math.cosh(twice * eta)
        across -= factor * math.cos(twice * xi) * math.sinh(twice * eta)
    conformal = math.asin(math.sin(along) / math.cosh(across))
    lat_rad = conformal + sum(
        factor * math.sin(twice * conformal)
        for twice, factor in zip((2, 4, 6, 8), _TO_ELLIPSOID, strict=True)
    )
    lon_rad = math.atan2(math.sinh(across), math.cos(along))
    return math.degrees(lat_rad), 6.0 * zone.number - 183.0 + math.degrees(lon_rad)
