"""The UTM grid: properties of a transverse Mercator projection, checked without its series."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.site.utm import Zone, lat_lon_of, zone_of

A_M, F = 6_378_137.0, 1 / 298.257_223_563
E2 = F * (2 - F)
ZONE_32 = Zone(32, is_south=False)  # about 9 degrees east


def meridian_m(lat_deg: float) -> float:
    """Length along the meridian from the equator, integrated step by step."""
    lat = np.linspace(0.0, math.radians(lat_deg), 200_001)
    radius_m = A_M * (1 - E2) / (1 - E2 * np.sin(lat) ** 2) ** 1.5
    return float(np.trapezoid(radius_m, lat))


@pytest.mark.parametrize("lat_deg", [0.5, 30.0, 52.0, 71.0])
def test_on_the_middle_meridian_lengths_are_true_up_to_the_scale(lat_deg: float) -> None:
    north_m = 0.9996 * meridian_m(lat_deg)
    assert lat_lon_of(ZONE_32, 500_000.0, north_m) == pytest.approx((lat_deg, 9.0), abs=1e-8)


@pytest.mark.parametrize(("east_m", "north_m"), [(650_000.0, 5_800_000.0), (300_000.0, 7.8e6)])
def test_beside_it_angles_are_true(east_m: float, north_m: float) -> None:
    """A step east and one north are at right angles on the Earth and of one length."""

    def step(to_east_m: float, to_north_m: float) -> tuple[float, float]:
        lat, lon = np.radians(lat_lon_of(ZONE_32, east_m + to_east_m, north_m + to_north_m))
        lat_0, lon_0 = np.radians(lat_lon_of(ZONE_32, east_m - to_east_m, north_m - to_north_m))
        bulge = 1 - E2 * math.sin((lat + lat_0) / 2) ** 2
        north = A_M * (1 - E2) / bulge**1.5 * (lat - lat_0)
        east = A_M / math.sqrt(bulge) * math.cos((lat + lat_0) / 2) * (lon - lon_0)
        return float(north), float(east)

    to_east, to_north = step(50.0, 0.0), step(0.0, 50.0)
    assert math.hypot(*to_east) == pytest.approx(math.hypot(*to_north), rel=1e-7)
    assert to_east[0] * to_north[0] + to_east[1] * to_north[1] == pytest.approx(0.0, abs=1e-3)
    assert 100.0 / math.hypot(*to_east) == pytest.approx(
        0.9996 * (1 + ((east_m - 500_000.0) / 0.9996 / 6.38e6) ** 2 / 2), rel=1e-5
    )


def test_south_mirrors_the_north() -> None:
    lat_deg, lon_deg = lat_lon_of(ZONE_32, 420_000.0, 3_000_000.0)
    south = lat_lon_of(Zone(32, is_south=True), 420_000.0, 7_000_000.0)
    assert south == pytest.approx((-lat_deg, lon_deg))


def test_zones_go_by_their_numbers() -> None:
    assert zone_of("EPSG:25833") == Zone(33, is_south=False)
    assert zone_of("EPSG:32633") == Zone(33, is_south=False)
    assert zone_of("EPSG:32756") == Zone(56, is_south=True)
    for other in ("EPSG:32661", "EPSG:32600", "EPSG:3857", "EPSG:258333", "25833"):
        assert zone_of(other) is None


@pytest.mark.parametrize("place", [(4.0, 5e7), (math.inf, 5e6), (5e6, 5e6)])
def test_place_outside_the_grid_has_no_coordinates(place: tuple[float, float]) -> None:
    assert all(map(math.isnan, lat_lon_of(ZONE_32, *place)))
