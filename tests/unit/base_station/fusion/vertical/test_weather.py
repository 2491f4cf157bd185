"""Weather shared by barometers: which of them count, by how much, and for how long."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.fusion.interface import BarometricHeight
from base_station.fusion.vertical.weather import FRESH_NS, Barometers, Weather
from shared.clock import NS_PER_S
from shared.geo import pressure_pa_at
from shared.messages import Header
from tests.rig import message_factory

SITE_M = 120.0


def note_pressures(
    weather: Weather, seconds: range, rise_m: float = 0.0, name: str = "one"
) -> None:
    for second in seconds:
        weather.note(name, second * NS_PER_S, SITE_M + rise_m, 0.0)


@pytest.mark.parametrize("ago_s", [10, 3600, 86_400])
def test_position_with_a_wrong_clock_makes_no_weather(ago_s: int) -> None:
    weather = Weather()
    note_pressures(weather, range(60))
    weather.note("one", (60 - ago_s) * NS_PER_S, SITE_M + 0.5, 0.0)
    assert weather.rise_m == 0.0
    note_pressures(weather, range(61, 90))
    assert weather.rise_m == 0.0


def test_ended_runs_are_not_kept() -> None:
    """A station runs for years, and every run of every unit is a barometer of its own."""
    barometers = Barometers()
    for run in range(100):
        for second in range(3):
            header = Header("FF-01", run, second, 0)
            position = message_factory.position(header, pressure_pa=pressure_pa_at(SITE_M))
            t_ns = (60 * run + second) * NS_PER_S
            barometers.update("FF-01", t_ns, position, is_outside=True)
    assert len(barometers.weather.sources) == 1


def test_barometer_that_returns_begins_at_the_held_weather() -> None:
    weather = Weather()
    note_pressures(weather, range(100), 0.0, "one")
    note_pressures(weather, range(100, 200), 30.0, "two")
    assert weather.rise_m == 0.0
    note_pressures(weather, range(200, 300), 60.0, "one")
    assert weather.rise_m == 0.0


@pytest.mark.parametrize("count", [1, 2, 3])
def test_common_pressure_is_followed_in_ten_seconds_by_any_number(count: int) -> None:
    """Nearly: each counts by its share of them."""
    weather = Weather()
    for second in range(40):
        for name in range(count):
            weather.note(str(name), second * NS_PER_S, SITE_M + 1.0 * (second >= 30), 0.0)
    assert weather.rise_m == pytest.approx(1.0 - np.exp(-1.0), abs=0.06)


def test_climbing_unit_makes_no_weather() -> None:
    weather = Weather()
    for second in range(60):
        weather.note("one", second * NS_PER_S, SITE_M + 0.3 * second, -0.3 * second)
    assert weather.rise_m == pytest.approx(0.0, abs=1e-9)


def test_weather_is_known_while_a_barometer_shows_it() -> None:
    weather = Weather()
    assert not weather.is_known(0)
    note_pressures(weather, range(5, 6))
    assert weather.is_known(5 * NS_PER_S + FRESH_NS)
    assert not weather.is_known(5 * NS_PER_S + FRESH_NS + 1)


def barometric_height(
    barometers: Barometers, unit_id: str, second: int, height_m: float, *, is_outside: bool = True
) -> BarometricHeight:
    header = Header(unit_id, 1, second, message_factory.mono_ns(second))
    position = message_factory.position(header, pressure_pa=pressure_pa_at(height_m))
    air = barometers.update(unit_id, second * NS_PER_S, position, is_outside=is_outside)
    assert air is not None
    assert air.t_mono_ns == header.t_mono_ns
    return air


def test_weather_without_a_reference_is_of_barometers_outside() -> None:
    barometers = Barometers()
    first = barometric_height(barometers, "FF-02", 0, SITE_M, is_outside=False)
    assert not first.referenced
    for second in range(100):
        barometric_height(barometers, "FF-01", second, SITE_M + 0.05 * second)
        inside = barometric_height(
            barometers, "FF-02", second, SITE_M + 0.05 * second, is_outside=False
        )
    assert inside.referenced
    assert inside.down_m == pytest.approx(first.down_m, abs=0.6)
    alone = [
        barometric_height(barometers, "FF-02", second, SITE_M, is_outside=False)
        for second in (109, 120)
    ]
    assert [one.referenced for one in alone] == [True, False]


def test_weather_with_a_reference_is_of_it_alone() -> None:
    barometers = Barometers()
    barometers.set_reference("REF", -2.0)
    for second in range(60):
        barometric_height(barometers, "REF", second, SITE_M)
        barometric_height(barometers, "FF-01", second, SITE_M + 0.5 * second)
    assert barometers.weather.rise_m == 0.0


def test_other_reference_at_another_place_moves_no_member() -> None:
    barometers = Barometers()
    places = (("REF", SITE_M), ("REF", SITE_M + 9.0), ("FF-09", SITE_M - 50.0))
    for at, (unit_id, height_m) in enumerate(places):
        barometers.set_reference(unit_id, 0.0)
        for second in range(8 * at, 8 * at + 8):
            barometric_height(barometers, unit_id, second, height_m)
    assert barometers.weather.rise_m == 0.0


def test_reference_that_is_carried_upstairs_moves_no_member() -> None:
    """Its height is no weather; where it is put down, it measures the weather again."""
    barometers, seq, way_m = Barometers(), 0, 0.0

    def height_of_air(height_m: float) -> BarometricHeight | None:
        nonlocal seq
        seq += 1
        header = Header("REF", 1, seq, message_factory.mono_ns(0.2 * seq))
        position = message_factory.position(
            header, distance_m=way_m, pressure_pa=pressure_pa_at(height_m)
        )
        return barometers.update("REF", seq * NS_PER_S // 5, position, is_outside=True)

    barometers.set_reference("REF", 0.0)
    for _ in range(100):
        height_of_air(SITE_M)
    for step in range(100):
        way_m += 0.6 if step % 5 == 0 else 0.0  # a stride
        air = height_of_air(SITE_M + 0.08 * step)
    assert barometers.weather.rise_m == pytest.approx(0.0, abs=0.05)
    assert air is not None
    assert not air.referenced
    for step in range(450):
        air = height_of_air(SITE_M + 8.0 + 0.01 * max(step - 50, 0))
    assert barometers.weather.rise_m == pytest.approx(4.0, abs=0.6)
    assert air is not None
    assert air.referenced


def test_reference_that_is_restarted_measures_again() -> None:
    """Its path begins anew with it, and leads nowhere."""
    barometers = Barometers()
    barometers.set_reference("REF", 0.0)
    for second in range(60):
        header = Header("REF", 1 + second // 30, second, message_factory.mono_ns(second))
        distance_m = 3.0 if second < 30 else 7.0
        pressure_pa = pressure_pa_at(SITE_M + 0.1 * second)
        position = message_factory.position(header, distance_m=distance_m, pressure_pa=pressure_pa)
        barometers.update("REF", second * NS_PER_S, position, is_outside=True)
    assert barometers.weather.rise_m == pytest.approx(5.0, abs=0.4)


def test_late_pressure_leaves_the_weather_known() -> None:
    weather = Weather()
    note_pressures(weather, range(60))
    note_pressures(weather, range(50, 53), name="two")
    assert weather.is_known(59 * NS_PER_S + FRESH_NS)


@pytest.mark.parametrize(
    ("pressure_pa", "is_used"),
    [(29_000.0, False), (33_000.0, True), (115_000.0, True), (121_000.0, False)],
)
def test_pressure_is_used_at_inhabited_heights(pressure_pa: float, is_used: bool) -> None:
    position = message_factory.position(Header("FF-01", 1, 1, 0), pressure_pa=pressure_pa)
    air = Barometers().update("FF-01", 0, position, is_outside=True)
    assert (air is not None) is is_used
