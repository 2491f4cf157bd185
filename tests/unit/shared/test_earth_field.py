"""The earth's magnetic field: published points, and what lies outside the model."""

from __future__ import annotations

from datetime import UTC, datetime
from math import degrees, nan

import pytest

from shared.earth_field import EarthField, earth_field

# From the test values that NOAA and BGS publish with the model of 2025: year, height in km,
# latitude, longitude and declination in degrees.
PUBLISHED_2025 = [
    (2025.0, 0, 80, 0, 1.28),
    (2025.0, 0, 0, 120, -0.16),
    (2025.0, 0, -80, 240, 68.78),
    (2025.0, 48, 80, -96, -29.91),
    (2025.0, 28, 89, -121, -99.77),
    (2025.0, 18, 0, 21, 1.29),
    (2025.5, 6, -36, -137, 20.28),
    (2027.5, 0, 80, 0, 2.59),
    (2027.5, 0, 0, 120, -0.24),
    (2027.5, 0, -80, 240, 68.49),
]
HOUSE = (50.85, 4.35)


def at(year: float) -> int:
    """UTC in nanoseconds of a year with its fraction."""
    first = datetime(int(year), 1, 1, tzinfo=UTC)
    length = datetime(int(year) + 1, 1, 1, tzinfo=UTC) - first
    return round((first + (year - int(year)) * length).timestamp() * 1e9)


def field(lat_deg: float, lon_deg: float, year: float, height_m: float = 0.0) -> EarthField:
    found = earth_field(lat_deg, lon_deg, height_m, at(year))
    assert isinstance(found, EarthField)
    return found


@pytest.mark.parametrize(("year", "height_km", "lat", "lon", "declination"), PUBLISHED_2025)
def test_declination_is_as_published(
    year: float, height_km: float, lat: float, lon: float, declination: float
) -> None:
    found = field(lat, lon, year, height_km * 1e3)
    assert degrees(found.declination_rad) == pytest.approx(declination, abs=0.006)


def test_strength_and_dip_are_as_published() -> None:
    # Report on the model of 2025, table of test values, 2025.0 at 80 N, 0 E, on the ellipsoid.
    found = field(80.0, 0.0, 2025.0)
    assert found.horizontal_ut == pytest.approx(6.5232, abs=1e-4)
    assert found.down_ut == pytest.approx(54.7915, abs=1e-4)


def test_declination_of_a_day_is_that_of_the_model_of_its_time() -> None:
    # NOAA's calculator, 4 July 2026.
    day = round(datetime(2026, 7, 4, tzinfo=UTC).timestamp() * 1e9)
    for lat, lon, declination in (
        (-33.8688, 151.2093, 12.82083),
        (51.5074, -0.1278, 1.16280),
        (64.1466, -21.9426, -11.13349),
    ):
        found = earth_field(lat, lon, 0.0, day)
        assert isinstance(found, EarthField)
        assert degrees(found.declination_rad) == pytest.approx(declination, abs=0.01)


@pytest.mark.parametrize("border", [2015.0, 2020.0, 2025.0])
def test_one_model_goes_over_into_the_next(border: float) -> None:
    before, after = field(*HOUSE, border - 1e-4), field(*HOUSE, border)
    step = abs(after.declination_rad - before.declination_rad)
    assert 0.0 < step < after.declination_std_rad  # another model, of about the same field


def test_after_its_end_the_last_model_is_carried_on_with_more_doubt_each_year() -> None:
    last, later = field(*HOUSE, 2029.9), field(*HOUSE, 2034.9)
    assert later.declination_std_rad > 1.3 * last.declination_std_rad
    assert abs(later.declination_rad - last.declination_rad) < 0.03


@pytest.mark.parametrize("year", [1970.0, 2009.99, 2035.0, 2200.0])
def test_a_date_without_a_model_is_refused_in_words(year: float) -> None:
    found = earth_field(*HOUSE, 0.0, at(year))
    assert isinstance(found, str)
    assert "clock" in found


def test_a_date_that_is_none_is_refused() -> None:
    assert isinstance(earth_field(*HOUSE, 0.0, 2**62 * 8), str)


@pytest.mark.parametrize("place", [(91.0, 0.0, 0.0), (0.0, nan, 0.0), (0.0, 0.0, 1e6)])
def test_a_place_that_is_none_is_refused(place: tuple[float, float, float]) -> None:
    assert isinstance(earth_field(*place, at(2026.0)), str)


def test_near_a_magnetic_pole_the_declination_is_hardly_known() -> None:
    assert degrees(field(85.5, 139.0, 2026.0).declination_std_rad) > 3.0


def test_at_the_geographic_poles_there_is_an_answer() -> None:
    assert field(90.0, 0.0, 2026.0).down_ut > 50.0
