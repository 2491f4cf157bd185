"""Signs and inverses of the functions of latitude, longitude and pressure."""

from __future__ import annotations

import math

import pymap3d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shared.geo import Anchor, anchor_through, pressure_altitude_m, pressure_pa_at, rotate, wrap_pi

METRES = st.floats(-5000.0, 5000.0)
TURNS = st.floats(-math.pi, math.pi)


def test_a_degree_north_is_north_and_a_degree_east_is_east() -> None:
    anchor = Anchor(52.0, 4.0, 0.0)
    north_m, east_m, down_m = anchor.to_incident_m(52.001, 4.0, 5.0)
    assert north_m == pytest.approx(111.3, abs=0.1)
    assert east_m == pytest.approx(0.0, abs=1e-6)
    assert down_m == pytest.approx(-5.0, abs=0.01)
    assert anchor.to_incident_m(52.0, 4.001, 0.0)[1] == pytest.approx(68.7, abs=0.1)


def test_a_plan_turned_to_the_east_has_its_north_there() -> None:
    """The frame's north has a true heading of 90 degrees."""
    anchor = Anchor(52.0, 4.0, 0.0, math.pi / 2.0)
    north_m, east_m, _ = anchor.to_incident_m(52.0, 4.001, 0.0)
    assert (north_m, east_m) == pytest.approx((68.7, 0.0), abs=0.1)


def test_turning_clockwise_takes_north_to_east() -> None:
    assert rotate(1.0, 0.0, math.pi / 2.0) == pytest.approx((0.0, 1.0))


@given(METRES, METRES, METRES, TURNS)
def test_there_and_back(north_m: float, east_m: float, down_m: float, turn_rad: float) -> None:
    anchor = Anchor(-33.0, 151.0, 30.0, turn_rad)
    back = anchor.to_incident_m(*anchor.to_geodetic(north_m, east_m, down_m))
    assert back == pytest.approx((north_m, east_m, down_m), abs=1e-5)


@given(st.floats(-89.9, 89.9), st.floats(-180.0, 180.0), st.floats(-400.0, 9000.0), METRES, METRES)
def test_a_place_is_where_the_library_has_it(
    lat_deg: float, lon_deg: float, height_m: float, north_m: float, east_m: float
) -> None:
    place = Anchor(lat_deg, lon_deg, height_m).to_geodetic(north_m, east_m, -3.0)
    theirs = pymap3d.ned2geodetic(north_m, east_m, -3.0, lat_deg, lon_deg, height_m)
    assert place[0] == pytest.approx(theirs[0], abs=1e-10)
    assert wrap_pi(math.radians(place[1] - float(theirs[1]))) == pytest.approx(0.0, abs=1e-9)
    assert place[2] == pytest.approx(theirs[2], abs=1e-6)


@given(st.floats(-500.0, 500.0), st.floats(-500.0, 500.0))
def test_an_anchor_through_a_place_puts_it_there(north_m: float, east_m: float) -> None:
    anchor = anchor_through(47.0, 8.0, 400.0, (north_m, east_m, -2.0))
    place = anchor.to_incident_m(47.0, 8.0, 400.0)
    assert place == pytest.approx((north_m, east_m, -2.0), abs=0.1)


@pytest.mark.slow
@given(st.floats(-400.0, 9000.0))
def test_pressure_and_height_are_inverse(height_m: float) -> None:
    assert pressure_altitude_m(pressure_pa_at(height_m)) == pytest.approx(height_m, abs=1e-6)


def test_a_storey_is_about_38_pascal() -> None:
    assert pressure_pa_at(0.0) == pytest.approx(101_325.0)
    assert pressure_pa_at(0.0) - pressure_pa_at(3.2) == pytest.approx(38.4, abs=0.2)


@pytest.mark.parametrize("pressure_pa", [0.0, -5.0, math.nan])
def test_no_pressure_is_an_error(pressure_pa: float) -> None:
    with pytest.raises(ValueError, match="pressure"):
        pressure_altitude_m(pressure_pa)


@given(st.floats(-100.0, 100.0))
def test_a_wrapped_angle_is_the_same_angle(angle_rad: float) -> None:
    wrapped = wrap_pi(angle_rad)
    assert -math.pi <= wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle_rad))
    assert math.sin(wrapped) == pytest.approx(math.sin(angle_rad), abs=1e-9)
