"""The place of a model on the Earth: by its map conversion, or by the site's latitude."""

from __future__ import annotations

import math
from typing import Any

import pytest

from base_station.drawings.ifc_place import place_of
from tests.rig.ifc_house import IfcHouse

# 9 degrees east is the middle of UTM zone 32: grid north is true north there.
MIDDLE_EAST_M, NORTH_M = 500_000.0, 5_400_000.0


def mapped(house: IfcHouse, crs: str, east: float, turned_rad: float = 0.0) -> None:
    """Map conversion of the model's origin, whose x axis is turned left of the grid's east."""
    grid = house.file.create_entity("IfcProjectedCRS", crs)
    house.file.create_entity(
        "IfcMapConversion", house.context, grid, east, NORTH_M / house.unit_m, 0.0,
        math.cos(turned_rad), math.sin(turned_rad),
    )  # fmt: skip


def sited(house: IfcHouse, true_north: tuple[float, float] | None = None) -> None:
    house.site.RefLatitude, house.site.RefLongitude = (57, 42, 0, 0), (-11, -58, -12, -500_000)
    if true_north:
        house.context.TrueNorth = house.file.create_entity("IfcDirection", true_north)


@pytest.mark.parametrize("unit_m", [1.0, 0.001])
def test_a_map_conversion_is_a_surveyed_place(unit_m: float) -> None:
    house = IfcHouse(unit_m=unit_m)
    mapped(house, "EPSG:25832", MIDDLE_EAST_M / unit_m)
    place, notes = place_of(house.file, unit_m, (0.0, 0.0))
    assert place is not None
    assert (place.is_surveyed, notes) == (True, ())
    assert place.lon_deg == pytest.approx(9.0, abs=1e-6)
    assert place.lat_deg == pytest.approx(48.7526, abs=1e-3)
    assert place.rotation_rad == pytest.approx(0.0, abs=1e-4)


def test_eastings_in_metres_are_taken_also_where_the_file_is_in_millimetres() -> None:
    house = IfcHouse(unit_m=0.001)
    grid = house.file.create_entity("IfcProjectedCRS", "EPSG:25832")
    house.file.create_entity(
        "IfcMapConversion", house.context, grid, MIDDLE_EAST_M, NORTH_M, 0.0, 1.0, 0.0
    )
    place, _ = place_of(house.file, 0.001, (0.0, 0.0))
    assert place is not None
    assert place.lat_deg == pytest.approx(48.7526, abs=1e-3)


def test_a_model_that_is_turned_left_has_its_north_west_of_north() -> None:
    house = IfcHouse()
    mapped(house, "EPSG:25832", MIDDLE_EAST_M, math.radians(30.0))
    place, _ = place_of(house.file, 1.0, (0.0, 100.0))
    assert place is not None
    assert math.degrees(place.rotation_rad) == pytest.approx(-30.0, abs=0.01)
    assert place.lon_deg < 9.0


def test_the_grid_converges_with_true_north_beside_the_middle_of_its_zone() -> None:
    """About the difference of longitude times the sine of the latitude."""
    house = IfcHouse()
    mapped(house, "epsg:25832", 700_000.0)
    place, _ = place_of(house.file, 1.0, (0.0, 0.0))
    assert place is not None
    expected_deg = (place.lon_deg - 9.0) * math.sin(math.radians(place.lat_deg))
    assert math.degrees(place.rotation_rad) == pytest.approx(expected_deg, abs=0.02)


def test_a_grid_that_is_not_known_is_noted_and_the_site_suggests_the_place() -> None:
    house = IfcHouse()
    mapped(house, "EPSG:2056", 2_600_000.0)
    sited(house)
    place, notes = place_of(house.file, 1.0, (0.0, 0.0))
    assert place is not None
    assert not place.is_surveyed
    assert "EPSG:2056" in notes[0]


def test_a_site_suggests_a_place_with_true_north() -> None:
    house = IfcHouse(origin_m=(50.0, 20.0, 0.0))
    turn = math.radians(20.0)
    sited(house, (math.sin(turn), math.cos(turn)))
    at_site, _ = place_of(house.file, 1.0, (50.0, 20.0))
    assert at_site is not None
    assert (at_site.lat_deg, at_site.lon_deg) == pytest.approx((57.7, -11.970139), abs=1e-6)
    # True north lies right of the model's y axis, whose heading therefore is to the left.
    assert math.degrees(at_site.rotation_rad) == pytest.approx(-20.0)
    beyond, _ = place_of(house.file, 1.0, (50.0, 120.0))
    assert beyond is not None
    assert beyond.lat_deg > at_site.lat_deg
    assert beyond.lon_deg < at_site.lon_deg


@pytest.mark.parametrize("latitude", [None, (0, 0, 0), (91, 0, 0)])
def test_no_place_is_none(latitude: Any) -> None:
    house = IfcHouse()
    house.site.RefLatitude = latitude
    house.site.RefLongitude = (8, 0, 0) if latitude else None
    assert place_of(house.file, 1.0, (0.0, 0.0)) == (None, ())
