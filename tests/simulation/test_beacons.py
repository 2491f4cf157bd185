"""Beacons on a wearer's way, from the receiver to the trail that the station shows."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.simulation.factory import open_simulation
from edge.simulation.simulation import Simulation
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Message, Position, Sighting
from shared.messages.pins import PlaceBeacon, RemoveBeacon
from shared.messages.station import OpenIncident, SetPlan, SetStart
from tests.rig.station_script import Script

LASTS_S = 150
PLAN = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":0,"down_m":0},'
    b'{"floor":1,"down_m":-3.2}]},"features":[]}'
)
TimedMessages = list[tuple[float, Message]]


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return open_simulation("passes-beacons?seed=3")


@pytest.fixture(scope="module")
def stated(simulation: Simulation) -> TimedMessages:
    identity = UnitIdentity("1", "passes-beacons", "eskf", (FittedSensor(simulation.description),))
    tracker = make_tracker("eskf", simulation.description)
    unit = TrackerPipeline(
        identity, OneSensorTracker(tracker), HeaderFactory("FF-01", 7, ManualClock()), 2.0
    )
    batches = islice(simulation.batches(1.0), LASTS_S)
    messages = [message for batch in batches for message in unit.step(batch)]
    reported = [one for one in messages if isinstance(one, Position | Sighting)]
    return [(one.header.t_mono_ns / NS_PER_S, one) for one in reported]


def reported(simulation: Simulation, stated: TimedMessages, *, with_beacons: bool) -> Script:
    """A station whose unit begins where it does; which way it looked is off by ten degrees."""
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SetPlan(PLAN))
    north_m, east_m, _ = simulation.truth(np.zeros(1)).position_n_m[0].tolist()
    first = next(one for _, one in stated if isinstance(one, Position))
    second = simulation.truth(np.array([6.0, 9.0])).position_n_m
    own = [one for t_s, one in stated if isinstance(one, Position) and 6.0 <= t_s <= 9.0]
    true_rad = np.arctan2(*(second[1] - second[0])[1::-1])
    own_rad = np.arctan2(own[-1].east_m - own[0].east_m, own[-1].north_m - own[0].north_m)
    heading_rad = float(true_rad - own_rad) + 0.17
    assert first.north_m == pytest.approx(0.0, abs=0.1)
    script.act(SetStart("FF-01", north_m, east_m, 0.0, heading_rad, 0.5, 0.3))
    if with_beacons:
        for one in simulation.scenario.beacons:
            floor = round(-one.down_m / 3.2)
            script.act(PlaceBeacon(one.beacon_id, "", one.north_m, one.east_m, floor, 0.3, 5.0))
    for t_s, message in stated:
        script.now_s = t_s
        script.say(message)
    return script


def trail_off_m(simulation: Simulation, script: Script) -> float:
    """Mean, over the trail."""
    trail = script.pipeline.state.units["FF-01"].trails.shown
    begin_ns = script.records[0][0]
    t_s = np.array([(one.t_ns - begin_ns) / NS_PER_S for one in trail])
    places = np.array([(one.north_m, one.east_m) for one in trail])
    off = places - simulation.truth(t_s).position_n_m[:, :2]
    return float(np.linalg.norm(off, axis=1).mean())


def test_beacons_on_the_way_correct_the_trail(
    simulation: Simulation, stated: TimedMessages
) -> None:
    plain = reported(simulation, stated, with_beacons=False)
    pinned = reported(simulation, stated, with_beacons=True)
    state = pinned.pipeline.state
    verdicts = [state.site.pin_verdicts[pin_id].state for pin_id in state.site.pins]
    assert {pin.other_id for pin in state.site.pins.values()} >= {"entrance", "corridor-west"}
    assert verdicts.count("used") > 0.8 * len(verdicts)
    assert trail_off_m(simulation, pinned) < 0.7 * trail_off_m(simulation, plain)


def test_unplaced_beacons_wait_and_are_used_once_placed(
    simulation: Simulation, stated: TimedMessages
) -> None:
    script = reported(simulation, stated, with_beacons=False)
    state = script.pipeline.state
    assert {one.state for one in state.site.pin_verdicts.values()} == {"waiting"}
    script.act(PlaceBeacon("corridor-west", "", 7.0, 3.0, 0, 0.3, 5.0))
    assert "used" in {one.state for one in state.site.pin_verdicts.values()}
    script.act(RemoveBeacon("corridor-west"))
    assert {one.state for one in state.site.pin_verdicts.values()} == {"waiting"}


def test_simulation_of_a_seed_is_reproducible(simulation: Simulation) -> None:
    received = []
    for _ in range(2):
        batches = islice(simulation.batches(1.0), 30)
        received.append([one for batch in batches for one in batch.others])
    assert str(received[0]) == str(received[1])
