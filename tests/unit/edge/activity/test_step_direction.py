"""Steps of a foot: forward, backward, to a side, and turns on the spot."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from edge.activity.monitor import ActivityMonitor
from edge.activity.step_direction import StepDirection
from edge.activity.strides import Stride
from edge.simulation.legs import Leg, Stand, Turn, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S
from shared.messages import Mobility

FIRST: tuple[Leg, ...] = (Stand(3.0), Walk(((0.0, 15.0),)), Stand(4.0))
SIDES = {Mobility.LEFTWARD, Mobility.RIGHTWARD}


def ways(*legs: Leg, seed: int = 1) -> Counter[Mobility]:
    """Number of reports of each direction after a walk forward, ten times a second."""
    scenario = Scenario(name="x", summary="x", start=(0.0, 0.0), legs=(*FIRST, *legs))
    simulation = Simulation(scenario, seed)
    tracker = make_tracker("eskf", simulation.description)
    monitor, found, begin_ns = ActivityMonitor(), Counter[Mobility](), None
    for batch in simulation.batches():
        monitor.push(batch.imu, tracker.push(batch.imu))
        t_ns = int(batch.imu.t_ns[-1])
        way = monitor.mobility(t_ns)
        if begin_ns is None and t_ns > 15 * NS_PER_S and way is Mobility.STILL:
            begin_ns = t_ns  # the walk forward is over
        if begin_ns is not None:
            found[way] += 1
    return found


def most(found: Counter[Mobility]) -> Mobility:
    """Share of the reports with a direction."""
    reported = {way: n for way, n in found.items() if way not in (Mobility.STILL, Mobility.MOVING)}
    return max(reported, key=reported.__getitem__)


def test_steps_backward_are_distinguished_from_steps_forward() -> None:
    assert most(ways(Walk(((0.0, 25.0),), pace="backwards"), Stand(2.0))) is Mobility.BACKWARD
    assert most(ways(Walk(((0.0, 25.0),)), Stand(2.0))) is Mobility.FORWARD


def test_side_steps_are_reported() -> None:
    found = ways(Walk(((0.0, 25.0),), pace="sideways"), Stand(2.0))
    assert most(found) in SIDES


def test_a_turn_on_the_spot_is_reported() -> None:
    found = ways(Turn(270.0), Stand(3.0), Turn(90.0), Stand(3.0))
    assert most(found) is Mobility.TURNING


def stride(number: int, step_b: tuple[float, float], length_m: float = 1.4) -> Stride:
    step = np.array([*step_b, 0.0]) * length_m
    up_b = np.array([0.0, 0.0, -1.0])
    return Stride(number * NS_PER_S, 1.1, length_m, 0.0, up_b, step)


@pytest.mark.parametrize(
    ("step_b", "way"),
    [
        ((1.0, 0.0), Mobility.FORWARD),
        ((-1.0, 0.0), Mobility.BACKWARD),
        ((0.0, 1.0), Mobility.RIGHTWARD),
        ((0.0, -1.0), Mobility.LEFTWARD),
    ],
)
def test_step_is_compared_with_earlier_long_strides(
    step_b: tuple[float, float], way: Mobility
) -> None:
    direction = StepDirection()
    for number in range(5):
        direction.push(stride(number, (1.0, 0.0)))
    direction.push(stride(5, step_b, 0.6))
    assert direction.mobility(5 * NS_PER_S) is way
    assert direction.mobility(9 * NS_PER_S) is None


def test_direction_is_unknown_before_the_first_walk_forward() -> None:
    direction = StepDirection()
    direction.push(stride(1, (1.0, 0.0), 0.6))
    assert direction.mobility(NS_PER_S) is Mobility.MOVING


def test_minute_backward_does_not_change_the_forward_direction() -> None:
    direction = StepDirection()
    for number in range(30):
        direction.push(stride(number, (1.0, 0.0)))
    for number in range(30, 55):
        direction.push(stride(number, (-1.0, 0.0)))
    assert direction.mobility(54 * NS_PER_S) is Mobility.BACKWARD
