"""Published temperatures of a unit."""

from __future__ import annotations

import math

import pytest

from edge.agent.temperatures import AmbientTemperature, CurrentReadings
from edge.samples import AmbientSample
from shared.clock import NS_PER_S
from shared.messages import SensorTemperature


def test_the_hottest_of_the_air_is_published_with_all_of_them() -> None:
    ambient = AmbientTemperature(1.0)
    assert ambient.push(AmbientSample(0, 20.0, "back")) == (
        20.0,
        (SensorTemperature("back", 20.0),),
    )
    assert ambient.push(AmbientSample(NS_PER_S, 80.0, "front")) == (
        80.0,
        (SensorTemperature("back", 20.0), SensorTemperature("front", 80.0)),
    )


def test_ended_sensor_is_no_longer_the_hottest() -> None:
    ambient = AmbientTemperature(1.0)
    ambient.push(AmbientSample(0, 300.0, "front"))
    found = ambient.push(AmbientSample(6 * NS_PER_S, 20.0, "back"))
    assert found == (20.0, (SensorTemperature("back", 20.0),))


def test_a_step_does_not_wait_for_its_second() -> None:
    ambient = AmbientTemperature(1.0)
    readings = [(0.0, 20.0), (0.2, 21.0), (0.4, 120.0), (0.6, 121.0), (0.8, 60.0), (1.0, 60.0)]
    found = [ambient.push(AmbientSample(round(t_s * 1e9), degc)) for t_s, degc in readings]
    assert [each and each[0] for each in found] == [20.0, None, 120.0, None, 60.0, 60.0]


def test_a_sensor_without_a_name_is_the_only_one() -> None:
    assert AmbientTemperature(1.0).push(AmbientSample(0, 20.0)) == (20.0, ())


@pytest.mark.parametrize("degc", [math.nan, math.inf])
def test_invalid_temperature_is_not_published(degc: float) -> None:
    assert AmbientTemperature(1.0).push(AmbientSample(0, degc, "front")) is None
    readings = CurrentReadings()
    readings.push("cpu", 0, degc)
    assert readings.at(0) == ()
