"""Place of the incident frame on the Earth, and conversion of air pressure to height.

The incident frame's axes are north, east, down *of the plan*: with no anchor they mean nothing
more, and nothing moves when an anchor comes later.  The anchor says where the origin lies and
at which true heading the frame's north points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import pymap3d

# ICAO standard atmosphere, troposphere (ICAO Doc 7488): p = p0 * (1 - L h / T0) ** (g / (R L)).
SEA_LEVEL_PRESSURE_PA = 101_325.0
_LAPSE_OVER_T0_PER_M = 0.0065 / 288.15
# WGS-84.
_EQUATOR_M = 6_378_137.0
_POLE_M = _EQUATOR_M * (1.0 - 1.0 / 298.257223563)
_ECCENTRICITY2 = 1.0 - (_POLE_M / _EQUATOR_M) ** 2
_SECOND_ECCENTRICITY2 = (_EQUATOR_M / _POLE_M) ** 2 - 1.0
_EXPONENT = 9.80665 / (287.05287 * 0.0065)


@dataclass(frozen=True, slots=True)
class Anchor:
    """The incident frame's origin (WGS-84) and the true heading of its north axis."""

    lat_deg: float
    lon_deg: float
    height_m: float  # above the ellipsoid
    rotation_rad: float = 0.0

    def to_incident_m(
        self, lat_deg: float, lon_deg: float, height_m: float
    ) -> tuple[float, float, float]:
        """North, east, down in the incident frame."""
        north_m, east_m, down_m = pymap3d.geodetic2ned(
            lat_deg, lon_deg, height_m, self.lat_deg, self.lon_deg, self.height_m
        )
        north_m, east_m = rotate(float(north_m), float(east_m), -self.rotation_rad)
        return north_m, east_m, float(down_m)

    def plane_m(
        self, lat_deg: Sequence[float], lon_deg: Sequence[float]
    ) -> tuple[list[float], list[float]]:
        """North and east in the incident frame of many places, at the height of its origin."""
        if not lat_deg:
            return [], []
        north_m, east_m, _ = pymap3d.geodetic2ned(
            list(lat_deg), list(lon_deg), [self.height_m] * len(lat_deg),
            self.lat_deg, self.lon_deg, self.height_m,
        )  # fmt: skip
        places = (
            rotate(float(north), float(east), -self.rotation_rad)
            for north, east in zip(north_m, east_m, strict=True)
        )
        norths_m, easts_m = zip(*places, strict=True)
        return list(norths_m), list(easts_m)

    def to_geodetic(
        self, north_m: float, east_m: float, down_m: float
    ) -> tuple[float, float, float]:
        """Latitude and longitude in degrees, height above the ellipsoid in metres."""
        north_m, east_m = rotate(north_m, east_m, self.rotation_rad)
        (x0_m, y0_m, z0_m), (x, y, z) = _frame_at(self.lat_deg, self.lon_deg, self.height_m)
        return _geodetic_of(
            x0_m + x[0] * north_m + x[1] * east_m + x[2] * down_m,
            y0_m + y[0] * north_m + y[1] * east_m + y[2] * down_m,
            z0_m + z[0] * north_m + z[1] * east_m + z[2] * down_m,
        )


_Triple = tuple[float, float, float]


@lru_cache(maxsize=64)  # every position asks for that of the one anchor
def _frame_at(
    lat_deg: float, lon_deg: float, height_m: float
) -> tuple[_Triple, tuple[_Triple, ...]]:
    """Earth-centred position of a place, and by row x, y, z its north, east and down."""
    lat_rad, lon_rad = math.radians(lat_deg), math.radians(lon_deg)
    sin_lat, cos_lat = math.sin(lat_rad), math.cos(lat_rad)
    sin_lon, cos_lon = math.sin(lon_rad), math.cos(lon_rad)
    axes = (
        (-sin_lat * cos_lon, -sin_lon, -cos_lat * cos_lon),
        (-sin_lat * sin_lon, cos_lon, -cos_lat * sin_lon),
        (cos_lat, 0.0, -sin_lat),
    )
    x_m, y_m, z_m = pymap3d.geodetic2ecef(lat_deg, lon_deg, height_m)
    return (float(x_m), float(y_m), float(z_m)), axes


def _geodetic_of(x_m: float, y_m: float, z_m: float) -> tuple[float, float, float]:
    """Latitude, longitude and height of an Earth-centred place by Bowring's formula (1976), to
    a nanometre this side of aeroplanes; pymap3d's way for whole arrays takes twenty times as
    long for one place, and every position on every console needs one.
    """
    from_axis_m = math.hypot(x_m, y_m)
    reduced_rad = math.atan2(z_m * _EQUATOR_M, from_axis_m * _POLE_M)
    flattened_z_m = z_m + _SECOND_ECCENTRICITY2 * _POLE_M * math.sin(reduced_rad) ** 3
    flattened_axis_m = from_axis_m - _ECCENTRICITY2 * _EQUATOR_M * math.cos(reduced_rad) ** 3
    lat_rad = math.atan2(flattened_z_m, flattened_axis_m)
    sine, cosine = math.sin(lat_rad), math.cos(lat_rad)
    surface_m = _EQUATOR_M * math.sqrt(1.0 - _ECCENTRICITY2 * sine * sine)
    height_m = from_axis_m * cosine + z_m * sine - surface_m
    return math.degrees(lat_rad), math.degrees(math.atan2(y_m, x_m)), height_m


def rotate(north_m: float, east_m: float, angle_rad: float) -> tuple[float, float]:
    """Turn a horizontal vector clockwise (from north towards east)."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return cosine * north_m - sine * east_m, sine * north_m + cosine * east_m


def anchor_through(
    lat_deg: float, lon_deg: float, height_m: float, position_m: tuple[float, float, float]
) -> Anchor:
    """The true-north anchor that puts ``position_m`` (north, east, down) on the given place, to
    some centimetres within 500 m: north is not quite parallel there.
    """
    north_m, east_m, down_m = position_m
    lat0_deg, lon0_deg, height0_m = pymap3d.ned2geodetic(
        -north_m, -east_m, -down_m, lat_deg, lon_deg, height_m
    )
    return Anchor(float(lat0_deg), float(lon0_deg), float(height0_m))


def wrap_pi(angle_rad: float) -> float:
    """The same angle in -pi..pi."""
    return math.remainder(angle_rad, 2.0 * math.pi)


def pressure_altitude_m(pressure_pa: float) -> float:
    """Height above the standard atmosphere's sea level at which this pressure is found.

    Raises ValueError for a pressure that is not positive.
    """
    if not pressure_pa > 0.0:
        raise ValueError(f"an air pressure of {pressure_pa} Pa")
    ratio = math.pow(pressure_pa / SEA_LEVEL_PRESSURE_PA, 1.0 / _EXPONENT)
    return (1.0 - ratio) / _LAPSE_OVER_T0_PER_M


def pressure_pa_at(altitude_m: float) -> float:
    """The inverse of ``pressure_altitude_m``, below 44 km."""
    ratio = math.pow(1.0 - _LAPSE_OVER_T0_PER_M * altitude_m, _EXPONENT)
    return SEA_LEVEL_PRESSURE_PA * ratio
