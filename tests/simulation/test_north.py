"""A calibrated magnetometer on a foot aligns the path with the plan, without GPS."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import msgspec
import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.samples import ApproximatePosition, SensorBatch
from edge.simulation.building import load_building
from edge.simulation.factory import find_scenario
from edge.simulation.simulation import UNCALIBRATED_SENSORS, Simulation
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Position
from shared.messages.station import SetAnchor, SetStart
from tests.bench.tracker.simulated_calibration import calibration_of
from tests.rig.station_script import Script

NOW_NS = round(datetime(2026, 7, 1, tzinfo=UTC).timestamp()) * NS_PER_S


def positions_of(simulation: Simulation) -> list[Position]:
    """Positions of a unit whose sensors are calibrated as documented."""
    calibration = calibration_of(simulation)
    sensor = calibration.described(simulation.description)
    anchor = load_building().anchor
    place = ApproximatePosition(round(anchor.lat_deg, 1), round(anchor.lon_deg, 1))
    identity = UnitIdentity("1", "simulated", "eskf", (FittedSensor(sensor, calibration),), place)
    header_factory = HeaderFactory("u1", 7, ManualClock(NOW_NS))
    pipeline = TrackerPipeline(
        identity, OneSensorTracker(make_tracker("eskf", sensor)), header_factory, 5.0
    )
    messages = [*pipeline.start()]
    for batch in simulation.batches(0.5):
        messages += pipeline.step(SensorBatch(batch.imu))  # no receiver
    messages += pipeline.finish()
    return [message for message in messages if isinstance(message, Position)]


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("plan_turned_deg", [0.0, 75.0])
def test_path_agrees_with_the_plan(seed: int, plan_turned_deg: float) -> None:
    scenario = find_scenario("square-60m")
    simulation = Simulation(scenario, seed, UNCALIBRATED_SENSORS)
    anchor, turned_rad = load_building().anchor, math.radians(plan_turned_deg)
    start_m = simulation.truth(np.array([0.0])).position_n_m[0]
    script = Script()
    script.register("u1")
    script.act(SetAnchor(anchor.lat_deg, anchor.lon_deg, anchor.height_m, turned_rad))
    on_plan_m = to_plan(start_m, turned_rad)
    script.act(SetStart("u1", *on_plan_m, 0.0, 0.0, 0.3, math.pi))
    begin_ns = None
    for position in positions_of(simulation):
        begin_ns = position.header.t_mono_ns if begin_ns is None else begin_ns
        script.now_s = (position.header.t_mono_ns - begin_ns) / NS_PER_S
        script.say(msgspec.structs.replace(position, header=script.header("u1")))
    script.tick()
    fused, now_s = script.fused[-1], script.now_s
    truth_m = to_plan(simulation.truth(np.array([now_s])).position_n_m[0], turned_rad)
    assert math.degrees(fused.heading_std_rad) < 12.0
    off_m = math.dist((fused.north_m, fused.east_m), truth_m)
    assert off_m < 3.0 * max(fused.std_north_m, fused.std_east_m) + 0.5


def to_plan(place_m: np.ndarray, turned_rad: float) -> tuple[float, float]:
    """North and east of the plan, which is turned clockwise on the Earth."""
    c, s = math.cos(turned_rad), math.sin(turned_rad)
    return float(c * place_m[0] + s * place_m[1]), float(-s * place_m[0] + c * place_m[1])
