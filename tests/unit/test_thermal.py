"""How fast heat uses up what the equipment can take, and how long a reading counts."""

from __future__ import annotations

import pytest

from base_station.live_state import UnitState
from base_station.units.thermal import dose_of
from shared.messages import Temperature
from tests.station_script import Script

U = "FF-01"


@pytest.mark.parametrize(
    ("up_to_degc", "whole_dose_s"),
    [(100.0, 1500.0), (160.0, 900.0), (260.0, 300.0), (800.0, 60.0)],
)
def test_each_class_lasts_as_long_as_equipment_of_it_does(
    up_to_degc: float, whole_dose_s: float
) -> None:
    assert dose_of(up_to_degc, whole_dose_s) == 1.0
    assert dose_of(up_to_degc, whole_dose_s / 4) == 0.25


def test_what_anybody_can_stand_in_is_no_dose() -> None:
    assert dose_of(60.0, 3600.0) == 0.0
    assert dose_of(60.1, 1500.0) == 1.0


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    script.temperature(U, 300.0)
    return script


def unit(script: Script) -> UnitState:
    return script.pipeline.state.units[U]


@pytest.mark.parametrize(("silent_s", "counted_s"), [(6.0, 6.0), (10.0, 10.0), (120.0, 10.0)])
def test_a_reading_counts_until_the_next_but_not_through_a_silence(
    script: Script, silent_s: float, counted_s: float
) -> None:
    script.now_s += silent_s
    script.temperature(U, 20.0)
    assert unit(script).heat_dose == pytest.approx(counted_s / 60.0)
    script.now_s += 60.0
    script.temperature(U, 20.0)
    assert unit(script).heat_dose == pytest.approx(counted_s / 60.0)


@pytest.mark.parametrize(("after_degc", "limit_s"), [(270.0, 60.0), (400.0, 60.0), (200.0, 300.0)])
def test_who_is_hot_before_and_after_a_silence_was_so_throughout(
    script: Script, after_degc: float, limit_s: float
) -> None:
    """As hot as the cooler one of both; the fire that takes the radio heats the equipment on."""
    script.now_s += 50.0
    script.temperature(U, after_degc)
    assert unit(script).heat_dose == pytest.approx(10.0 / 60.0 + 40.0 / limit_s)


def test_a_unit_whose_clock_is_set_back_takes_nothing_from_its_dose(script: Script) -> None:
    script.say(Temperature(script.header(U, captured_s=-500.0), 300.0))
    assert unit(script).temperature is not None
    assert unit(script).heat_dose == 0.0


def test_the_time_between_two_runs_of_a_unit_is_not_known(script: Script) -> None:
    script.now_s += 6.0
    script.boot_ids[U] = 8
    script.temperature(U, 300.0)
    assert unit(script).heat_dose == 0.0
