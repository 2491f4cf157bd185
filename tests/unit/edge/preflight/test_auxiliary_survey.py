"""Auxiliary sensors of a unit, compared with the expected ones."""

from __future__ import annotations

import math

import pytest

from edge.config import EdgeConfig
from edge.preflight.auxiliary_survey import AuxiliarySurvey
from edge.preflight.finding import CheckFinding, Severity
from edge.samples import (
    ACKNOWLEDGE,
    BEACON,
    AmbientSample,
    BatterySample,
    ButtonPress,
    GpsSample,
    OtherSample,
    SightingSample,
)
from edge.sources.interface import Quantity

BARE = EdgeConfig("bench:1")
FULL = EdgeConfig(
    "bench:1",
    gps="gpsd://",
    temperatures=("w1:1?name=front", "w1:2"),
    battery="auto",
    sightings="tcp:a:1",
)
BUTTONS = frozenset({Quantity.MAYDAY_BUTTON, Quantity.ACKNOWLEDGE_BUTTON})


def fix(std_m: float, fix_type: int = 3) -> GpsSample:
    return GpsSample(1, 50.0, 8.0, 200.0, std_m, 2 * std_m, fix_type, 9, 0.0, 0.0)


def survey(
    config: EdgeConfig, *samples: OtherSample, gives: frozenset[Quantity] = frozenset()
) -> dict[str, CheckFinding]:
    found = AuxiliarySurvey(config, gives)
    for sample in samples:
        found.push(sample)
    return {finding.subject: finding for finding in found.findings()}


def test_missing_equipment_is_a_warning_with_its_consequence() -> None:
    found = survey(BARE)
    assert set(found) == {"temperature", "battery", "satellites", "mayday button"}
    for finding in found.values():
        assert finding.level is Severity.WARNING
        assert finding.remedy


def test_silent_configured_sensor_has_failed() -> None:
    found = survey(FULL)
    for subject in ("temperature front", "temperature 2", "battery", "satellites"):
        assert found[subject].level is Severity.FAILED
    assert found["beacons"].text == "none in reach now"  # out here there may be none


def test_one_silent_sensor_of_two_is_named() -> None:
    found = survey(FULL, AmbientSample(1, 21.5, "front"))
    levels = {name: one.level for name, one in found.items() if "temperature" in name}
    assert levels == {"temperature 2": Severity.FAILED, "temperature front": Severity.OK}


def test_button_press_is_not_required_at_the_start() -> None:
    found = list(AuxiliarySurvey(BARE, BUTTONS).findings(asks_press=False))
    assert "button" not in {finding.subject for finding in found}


def test_a_unit_that_has_everything_is_ok() -> None:
    found = survey(
        FULL,
        AmbientSample(1, 21.5, "front"),
        AmbientSample(1, 20.5, "2"),
        BatterySample(1, 0.9, 20_000.0),
        fix(4.0),
        SightingSample(1, BEACON, "door", math.nan, math.nan),
        ButtonPress(1, ACKNOWLEDGE),
        gives=BUTTONS,
    )
    assert {finding.level for finding in found.values()} == {Severity.OK}
    assert found["temperature front"].text == "21.5 °C"
    assert found["battery"].text == "90% of the sensor, 5.6 h left"
    assert found["satellites"].text == "fix of 9 satellites, 4 m"
    assert found["button"].text == "pressed: acknowledge"


@pytest.mark.parametrize(
    ("sample", "subject", "level"),
    [
        (AmbientSample(1, 350.0, "front"), "temperature front", Severity.WARNING),
        (AmbientSample(1, math.nan, "front"), "temperature front", Severity.WARNING),
        (BatterySample(1, 0.1), "battery", Severity.FAILED),
        (BatterySample(1, 0.4), "battery", Severity.WARNING),
        (BatterySample(1, 0.9, 600.0), "battery", Severity.WARNING),
        (fix(80.0), "satellites", Severity.WARNING),
        (fix(math.nan), "satellites", Severity.WARNING),
        (fix(3.0, fix_type=0), "satellites", Severity.WARNING),
    ],
)
def test_impossible_or_temporary_values_are_found(
    sample: OtherSample, subject: str, level: Severity
) -> None:
    assert survey(FULL, sample)[subject].level is level


def test_button_that_was_not_pressed_is_not_known_to_work() -> None:
    assert survey(BARE, gives=BUTTONS)["button"].level is Severity.WARNING


def test_a_button_beside_the_source_calls_a_mayday() -> None:
    with_one = EdgeConfig("bench:1", button="evdev:AB Button")
    assert "mayday button" not in survey(with_one)
    assert survey(with_one)["button"].text == "not pressed during the check"
    pressed = survey(with_one, ButtonPress(1, ACKNOWLEDGE))
    assert pressed["button"].level is Severity.OK
