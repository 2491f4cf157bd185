"""Thermal dose: how fast heat uses up the equipment's tolerance, and how long a reading counts."""

from __future__ import annotations

import pytest

from base_station.core.state import UnitState
from base_station.core.state.unit_heat import ExposureInterval
from base_station.core.units.thermal_dose import MAX_INTERVALS, add_late, add_live, dose_of
from shared.channels import TEMPERATURE, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import Temperature
from shared.messages.station import CloseIncident, OpenIncident
from tests.rig.journaled_script import JournaledScript
from tests.rig.station_script import Script

U = "FF-01"


@pytest.mark.parametrize(
    ("up_to_degc", "whole_dose_s"),
    [(100.0, 1500.0), (160.0, 900.0), (260.0, 300.0), (800.0, 60.0)],
)
def test_each_heat_class_lasts_as_long_as_its_equipment(
    up_to_degc: float, whole_dose_s: float
) -> None:
    assert dose_of(up_to_degc, whole_dose_s) == 1.0
    assert dose_of(up_to_degc, whole_dose_s / 4) == 0.25


def test_bearable_temperature_adds_no_dose() -> None:
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
def test_reading_counts_until_the_next_but_not_through_a_silence(
    script: Script, silent_s: float, counted_s: float
) -> None:
    script.now_s += silent_s
    script.temperature(U, 20.0)
    assert unit(script).heat.dose == pytest.approx(counted_s / 60.0)
    script.now_s += 60.0
    script.temperature(U, 20.0)
    assert unit(script).heat.dose == pytest.approx(counted_s / 60.0)


@pytest.mark.parametrize(("after_degc", "limit_s"), [(270.0, 60.0), (400.0, 60.0), (200.0, 300.0)])
def test_heat_before_and_after_a_silence_counts_throughout(
    script: Script, after_degc: float, limit_s: float
) -> None:
    """At the cooler of both readings; a fire that cuts the radio heats the equipment on."""
    script.now_s += 50.0
    script.temperature(U, after_degc)
    assert unit(script).heat.dose == pytest.approx(10.0 / 60.0 + 40.0 / limit_s)


def test_clock_set_back_reduces_no_dose(script: Script) -> None:
    script.say(Temperature(script.header(U, captured_s=-500.0), 300.0))
    assert unit(script).heat.temperature is not None
    assert unit(script).heat.dose == 0.0


def test_time_between_two_runs_of_a_unit_is_unknown(script: Script) -> None:
    script.now_s += 6.0
    script.boot_ids[U] = 8
    script.temperature(U, 300.0)
    assert unit(script).heat.dose == 0.0


def degc_at(second: int) -> float:
    """Into the fire and out again, twice."""
    return {0: 20.0, 1: 120.0, 2: 280.0, 3: 90.0}[second // 15 % 4]


def backfilled_script(lost: range, boots: dict[int, int], pieces: int = 2) -> JournaledScript:
    """Two minutes of temperatures, of which some come late."""
    script = JournaledScript()
    script.register(U)
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(120):
        script.now_s += 1.0
        script.boot_ids[U] = boots.get(second, script.boot_ids.get(U, 7))
        script.out_of_reach = {U} if second in lost else set()
        script.temperature(U, degc_at(second))
    script.out_of_reach = set()
    script.status(U)
    if lost:
        script.fetch(U, pieces)
    return script


@pytest.mark.slow
@pytest.mark.parametrize("pieces", [1, 2, 5])
@pytest.mark.parametrize("lost", [range(20, 70), range(10), range(50, 120), range(33, 36)], ids=str)
@pytest.mark.parametrize("boots", [{}, {40: 8}], ids=["one run", "two runs"])
def test_backfilled_readings_count_as_live_ones(
    lost: range, boots: dict[int, int], pieces: int
) -> None:
    all_live, some_late = backfilled_script(range(0), boots), backfilled_script(lost, boots, pieces)
    assert unit(all_live).heat.dose > 0.4
    assert unit(some_late).heat.dose == pytest.approx(unit(all_live).heat.dose)
    shown = unit(some_late).heat.temperature
    assert shown is not None
    assert shown.ambient_degc == (degc_at(119) if 119 not in lost else degc_at(lost[0] - 1))


def heat_alarms(script: Script) -> list[tuple[str, str]]:
    return [(one.rule, one.text) for one in script.alarms if one.rule.startswith("heat")]


def test_budget_used_up_without_contact_is_reported_as_late() -> None:
    """No heat at present, and the equipment may fail all the same."""
    script = JournaledScript()
    script.register(U)
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(200):
        script.now_s += 1.0
        script.out_of_reach = {U} if 20 <= second < 180 else set()
        script.temperature(U, 300.0 if 60 <= second < 150 else 20.0)
        script.tick()
    assert heat_alarms(script) == []
    script.fetch(U)
    script.wait(5)
    assert heat_alarms(script) == [
        (
            "heat-dose",
            f"unit {U}: heat limit of the equipment reached some time ago, as its journal shows, "
            "it may fail",
        )
    ]


def test_heat_before_this_incident_does_not_count_in_it() -> None:
    script = backfilled_script(range(20, 70), {})
    before = unit(script).heat.dose
    late = script.header(U, captured_s=script.now_s + 5.0)
    script.act(CloseIncident("i1"))
    script.now_s += 60.0
    script.temperature(U, 20.0)
    script.act(OpenIncident("i2", "Dock Street"))
    script.now_s += 10.0
    script.temperature(U, 20.0)
    assert before > 0.0
    assert unit(script).heat.dose == 0.0
    for header, counts in ((late, False), (script.header(U, script.now_s - 5.0), True)):
        hot = encode(Temperature(header, 300.0))
        script.record(backfilled_key(U, TEMPERATURE.suffix), hot)
        assert (unit(script).heat.dose > 0.0) == counts


def on_a_link_that_stutters(lost: set[int]) -> JournaledScript:
    """On an intermittent link for longer than single intervals are kept, with a fire at the
    beginning.
    """
    script = JournaledScript()
    script.register(U)
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(6 * MAX_INTERVALS):
        script.now_s += 1.0
        script.out_of_reach = {U} if second in lost else set()
        script.temperature(U, 280.0 if 100 <= second < 140 else 20.0)
    script.out_of_reach = set()
    script.status(U)
    return script


@pytest.mark.parametrize(
    "in_the_fire", [range(90, 150), range(92, 150, 3)], ids=["out of reach", "stuttering"]
)
def test_fire_at_the_begin_of_a_long_intermittent_link_counts_once(
    in_the_fire: range,
) -> None:
    script = on_a_link_that_stutters({*in_the_fire, *range(200, 6 * MAX_INTERVALS, 3)})
    assert len(unit(script).heat.exposures) == MAX_INTERVALS
    script.fetch(U, 50)
    # Within a second at either end of it.
    assert unit(script).heat.dose == pytest.approx(40.0 / 60.0, abs=2.0 / 60.0)
    assert len(unit(script).heat.exposures) <= MAX_INTERVALS


@pytest.mark.parametrize("late_s", [5.0, 11.0 * MAX_INTERVALS - 5.0])
def test_reading_of_a_silence_that_was_counted_changes_nothing(late_s: float) -> None:
    """The assumed heat stands: it is neither counted again nor removed."""
    stretches: list[ExposureInterval] = []
    for row in range(2 * MAX_INTERVALS):
        add_live(stretches, 7, row * 11 * NS_PER_S, 300.0)
    assert len(stretches) == MAX_INTERVALS
    assert add_late(stretches, 7, round(late_s * NS_PER_S), 300.0) == 0.0
    assert add_late(stretches, 7, round(late_s * NS_PER_S), 20.0) == 0.0


def test_known_intervals_take_bounded_room() -> None:
    script = backfilled_script(range(20, 70), {})
    assert len(unit(script).heat.exposures) == 1
    for _ in range(MAX_INTERVALS + 300):
        script.now_s += 11.0
        script.temperature(U, 20.0)
    assert len(unit(script).heat.exposures) == MAX_INTERVALS
