"""Floors under weather, doors and fans: a pressure change without a climb moves nobody."""

from __future__ import annotations

import math
from collections.abc import Callable

import msgspec
import numpy as np
import pytest

from base_station.fusion.interface import BarometricHeight
from base_station.fusion.parameters import Parameters
from base_station.fusion.vertical.height import HeightFilter
from base_station.fusion.vertical.weather import Barometers, Weather
from shared.clock import NS_PER_S
from shared.geo import pressure_pa_at
from shared.messages import Position

STOREYS_DOWN_M = (0.0, -3.2, -6.4, -9.6)
SITE_M = 120.0
PA_PER_M = pressure_pa_at(SITE_M + 1.0) - pressure_pa_at(SITE_M)


def down_of(added_pa: float, down_m: float = 0.0) -> float:
    """Height above the site by a barometer, negative."""
    return down_m - added_pa / PA_PER_M


@pytest.fixture
def position(make_position: Callable[..., Position]) -> Position:
    return make_position()


class Wearer:
    """Walks a metre a second; a climb takes as many seconds as it has steps of 0.2 m."""

    def __init__(self) -> None:
        self.height = HeightFilter(Parameters())
        self.height.reset(0.0, 0.2)
        self.t_s = 0
        self.rng = np.random.default_rng(1)
        self.true_down_m = 0.0

    def second(self, added_pa: float, *, climbs_m: float = 0.0, referenced: bool = False) -> None:
        self.t_s += 1
        self.true_down_m -= climbs_m
        self.height.predict(-climbs_m, 1.0)
        if self.height.walked_level:
            self.height.constrain_to_plan_floors(())
        noise_m = float(self.rng.normal(0.0, 0.15))
        air_m = down_of(added_pa, self.true_down_m) + 5.0 + noise_m
        self.height.update_barometer(BarometricHeight(self.t_s * NS_PER_S, air_m, referenced))

    @property
    def off_m(self) -> float:
        return abs(self.height.down_m - self.true_down_m)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_weather_of_350_pa_in_an_hour_changes_no_floor(sign: float) -> None:
    """Without any reference, and without a plan's storeys to hold on to: 29 m of pressure."""
    wearer, worst_m = Wearer(), 0.0
    for second in range(3600):
        wearer.second(sign * 350.0 * second / 3600.0)
        worst_m = max(worst_m, wearer.off_m)
    assert abs(down_of(350.0)) > 25.0
    assert worst_m < 1.0


def test_started_fan_is_no_stair() -> None:
    for step_pa in (-60.0, -30.0, 30.0, 60.0):
        wearer = Wearer()
        for second in range(300):
            wearer.second(step_pa if second > 120 else 0.0, referenced=True)
        assert wearer.off_m < 0.5
        assert math.sqrt(wearer.height.variance_m2) < 1.0


def test_stairs_are_climbed_with_the_fan_on() -> None:
    wearer = Wearer()
    for second in range(200):
        climbs_m = 0.2 if 100 <= second < 116 else 0.0
        wearer.second(-30.0 if second > 50 else 0.0, climbs_m=climbs_m, referenced=True)
    assert wearer.height.down_m == pytest.approx(-3.2, abs=0.4)


def test_level_walking_inside_sets_the_height_of_a_storey() -> None:
    height = HeightFilter(Parameters())
    height.reset(-2.8, 0.5)
    height.predict(0.0, 10.0)
    assert height.walked_level
    height.constrain_to_plan_floors(STOREYS_DOWN_M)
    assert height.down_m == pytest.approx(-3.2, abs=0.15)


def test_height_half_way_between_storeys_is_assigned_to_neither() -> None:
    height = HeightFilter(Parameters())
    height.reset(-1.6, 0.5)
    height.predict(0.0, 10.0)
    height.constrain_to_plan_floors(STOREYS_DOWN_M)
    assert height.down_m == pytest.approx(-1.6)


def test_weather_is_estimated_by_stationary_units_and_joining_units_move_no_height() -> None:
    weather = Weather()
    for second in range(600):
        rise_m = 0.01 * second
        weather.note("one", second * NS_PER_S, SITE_M + 7.0 + rise_m, 0.0)
        if second > 300:
            weather.note("other", second * NS_PER_S, SITE_M - 40.0 + rise_m, 0.0)
    assert weather.rise_m == pytest.approx(6.0, abs=0.2)
    assert weather.is_known(605 * NS_PER_S)
    assert not weather.is_known(700 * NS_PER_S)


def test_reference_barometer_alone_determines_the_weather(position: Position) -> None:
    barometers = Barometers()
    barometers.set_reference("REF", 0.0)
    for second in range(300):
        added_pa = second * 350.0 / 3600.0
        t_ns = second * NS_PER_S
        for unit_id, extra_pa in (("REF", 0.0), ("FF-01", 25.0)):
            pressure_pa = pressure_pa_at(SITE_M) + added_pa + extra_pa
            reported = msgspec.structs.replace(position, pressure_pa=pressure_pa)
            air = barometers.update(unit_id, t_ns, reported, is_outside=True)
    assert air is not None
    assert air.referenced
    first = down_of(25.0) - SITE_M
    assert air.down_m == pytest.approx(first, abs=0.3)


def test_impossible_pressure_is_ignored(position: Position) -> None:
    for pressure_pa in (None, 0.5, 1e6, math.nan):
        reported = msgspec.structs.replace(position, pressure_pa=pressure_pa)
        assert Barometers().update("FF-01", 0, reported, is_outside=True) is None
