"""Lifts, from the wearer's sensors to the floor that the station shows."""

from __future__ import annotations

import math
from functools import cache
from itertools import islice

import numpy as np
import pytest

from base_station.fusion.interface import BarometricHeight
from base_station.fusion.parameters import Parameters
from base_station.fusion.vertical.height import HeightFilter
from base_station.site.storeys import Storey
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.samples import Floats
from edge.simulation.factory import open_simulation
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import FusedPosition, Position
from shared.messages.station import SetPlan, SetStart
from tests.rig.station_script import Script

LASTS_S = 200
STOREY_M = 3.2
STOREYS = ",".join(f'{{"floor":{k},"down_m":{-STOREY_M * k:.1f}}}' for k in range(7))
PLAN = (
    f'{{"type":"FeatureCollection","muster":{{"frame":"site-m","floors":[{STOREYS}]}},'
    '"features":[]}'
).encode()


@cache
def ridden(scenario: str, *, with_plan: bool) -> tuple[list[FusedPosition], Floats]:
    """Shown estimate at each position of the wearer, and the true height (n,)."""
    simulation = open_simulation(scenario)
    identity = UnitIdentity("1", scenario, "eskf", (FittedSensor(simulation.description),))
    tracker = make_tracker("eskf", simulation.description)
    header_factory = HeaderFactory("FF-01", 7, ManualClock())
    unit = TrackerPipeline(identity, OneSensorTracker(tracker), header_factory, 2.0)
    script = Script()
    script.register("FF-01")
    script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.3, 0.1))
    if with_plan:
        script.act(SetPlan(PLAN))
    times_s, shown = [], []
    for batch in islice(simulation.batches(1.0), LASTS_S):
        for message in unit.step(batch):
            if isinstance(message, Position):
                script.now_s = message.header.t_mono_ns / NS_PER_S
                script.say(message)
                times_s.append(script.now_s)
                shown.append(script.fused[-1])
    places = simulation.truth(np.array([0.0, *times_s])).position_n_m
    return shown, places[0, 2] - places[1:, 2]


def settled(shown: list[FusedPosition], height_m: Floats) -> list[tuple[FusedPosition, int]]:
    """Shown estimates on the level of a storey, after the wearer has left the lift."""
    storeys = np.rint(height_m / STOREY_M).astype(int)
    level = np.abs(height_m - STOREY_M * storeys) < 0.3
    stays = [bool(level[max(0, row - 16) : row + 1].all()) for row in range(len(level))]
    return [
        (one, int(storeys[row]))
        for row, one in enumerate(shown)
        if stays[row] and one.floor is not None
    ]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_lift_ride_without_a_plan_ends_on_the_correct_floor(seed: int) -> None:
    """Nobody says how high a storey is."""
    shown, height_m = ridden(f"lift?seed={seed}", with_plan=False)
    floors = settled(shown, height_m)
    assert {storey for _, storey in floors} == {0, 1}
    wrong = [one for one, storey in floors if one.floor != storey]
    assert len(wrong) < 0.01 * len(floors)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_lift_rides_end_on_the_floors_of_the_plan(seed: int) -> None:
    floors = settled(*ridden(f"tower?seed={seed}", with_plan=True))
    assert {storey for _, storey in floors} == {0, 2, 4, 6}
    wrong = [one for one, storey in floors if one.floor != storey]
    assert len(wrong) < 0.01 * len(floors)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_height_errors_of_rides_agree_with_the_stated_uncertainty(seed: int) -> None:
    shown, height_m = ridden(f"tower?seed={seed}", with_plan=False)
    off = [
        (-one.down_m - true_m) / one.std_down_m for one, true_m in zip(shown, height_m, strict=True)
    ]
    assert np.percentile(np.abs(off), 95.0) < 2.0
    assert max(one.std_down_m for one in shown) < 1.5


def test_fused_height_during_a_ride_is_no_surer_than_the_units() -> None:
    height = HeightFilter(Parameters())
    height.reset(0.0, 0.2)
    for _ in range(20):
        height.predict(-0.5, 0.0, 0.8, moves=False)
    assert math.sqrt(height.variance_m2) > 0.8
    height.predict(0.0, 1.0, 0.15, moves=True)
    assert math.sqrt(height.variance_m2) < 0.4
    assert height.down_m == pytest.approx(-10.0)


def rest(height: HeightFilter, begin_s: int, airs_m: list[float]) -> None:
    """Stand still while the air says this, a look a second."""
    for second, air_m in enumerate(airs_m, begin_s):
        height.predict(0.0, 0.0, 0.1, moves=False)
        height.update_barometer(BarometricHeight(second * NS_PER_S, air_m, referenced=True))


def test_ride_undetected_by_the_unit_increases_the_height_uncertainty() -> None:
    """It may be a fan: nobody is moved, and nobody is sure."""
    height = HeightFilter(Parameters())
    height.reset(0.0, 0.2)
    ramp = [5.0 - 0.8 * min(second, 8) for second in range(20)]
    rest(height, 0, [5.0] * 30)
    rest(height, 30, ramp)
    assert abs(height.down_m) < 0.3
    assert math.sqrt(height.variance_m2) > 3.2


def test_undetected_ride_is_not_assigned_to_the_only_known_storey() -> None:
    """The first thing that somebody does; then they walk where nobody has walked before."""
    height = HeightFilter(Parameters())
    height.reset(0.0, 0.2)
    rest(height, 0, [5.0] * 5 + [5.0 - 0.9 * min(second, 18) for second in range(25)])
    height.predict(0.0, 8.0, 0.1)
    height.constrain_to_learnt_floors([Storey(0, 0.0, std_m=0.2)])
    assert math.sqrt(height.variance_m2) > 8.0


def test_slamming_doors_are_no_ride() -> None:
    """Waves of some metres, 1.5 a second, gone in a second or two (``edge.simulation``)."""
    for phase in range(10):
        height = HeightFilter(Parameters())
        height.reset(0.0, 0.2)
        for tick in range(600):
            age_s = (tick % 97) / 5.0 + 0.02 * phase
            wave_m = 4.0 * math.exp(-age_s / 0.4) * math.sin(3.0 * math.pi * age_s)
            height.predict(0.0, 0.0, 0.1, moves=False)
            height.update_barometer(
                BarometricHeight(tick * NS_PER_S // 5, 5.0 + wave_m, referenced=True)
            )
        assert math.sqrt(height.variance_m2) < 0.5


def test_opened_door_and_changing_weather_are_no_ride() -> None:
    for airs_m in ([5.0] * 10 + [8.0] * 30, [5.0 + 0.008 * k for k in range(600)]):
        height = HeightFilter(Parameters())
        height.reset(0.0, 0.2)
        rest(height, 0, airs_m)
        assert math.sqrt(height.variance_m2) < 0.5
