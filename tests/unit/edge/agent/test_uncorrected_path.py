"""Corrections of the walk behind are known, and are no steps of what is published."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from edge.agent.position_publisher import PositionPublisher
from edge.clocks.timeline import Timeline
from edge.simulation.factory import find_scenario
from edge.simulation.legs import Leg, Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import (
    CONSUMER_SENSORS,
    UNCALIBRATED_SENSORS,
    SensorErrors,
    Simulation,
)
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import join_rows
from shared.clock import NS_PER_S, SystemClock
from shared.header_factory import HeaderFactory
from tests.rig.inertial_walk import inertial_samples

RATE_HZ = 2.0
WINDOW_S = 5.0
AROUND: tuple[Leg, ...] = (
    Walk(to=((20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)) * 2),
    Stand(duration_s=8.0),
    Walk(to=((15.0, 5.0), (25.0, 30.0), (0.0, 10.0))),
)


def walked(simulation: Simulation) -> tuple[TrackBatch, np.ndarray, np.ndarray, np.ndarray]:
    """Rows; times (n,) of what is published of them, its places (n, 2), and the true ones."""
    tracker = EskfTracker(simulation.description)
    rows = join_rows([tracker.push(inertial_samples(simulation)), tracker.finish()])
    stream = PositionPublisher(HeaderFactory("u1", 1, SystemClock()), RATE_HZ)
    published = stream.push(rows, Timeline())
    places_m = np.array([(position.north_m, position.east_m) for position in published])
    t_s = np.array([position.header.t_mono_ns for position in published]) / NS_PER_S
    t_s -= t_s[0]
    return rows, t_s, places_m, simulation.truth(t_s).position_n_m[:, :2]


def worst_window_m(places_m: np.ndarray, truth_m: np.ndarray) -> float:
    """By how much the way of a few seconds is longest off the true one."""
    steps = round(WINDOW_S * RATE_HZ)
    lengths = [np.linalg.norm(p[steps:] - p[:-steps], axis=1) for p in (places_m, truth_m)]
    return float(np.abs(lengths[0] - lengths[1]).max())


def on_the_move(seed: int, sensors: SensorErrors) -> Simulation:
    return Simulation(Scenario(name="round", summary="", legs=AROUND), seed, sensors)


@pytest.mark.slow
@pytest.mark.parametrize("sensors", [CONSUMER_SENSORS, UNCALIBRATED_SENSORS])
def test_correction_by_a_rest_after_a_start_in_motion_is_no_step(sensors: SensorErrors) -> None:
    leaps_m = []
    for seed in range(6):
        rows, t_s, places_m, truth_m = walked(on_the_move(seed, sensors))
        at = np.searchsorted(rows.t_ns - rows.t_ns[0], np.rint(t_s * NS_PER_S))
        leaps_m.append(worst_window_m(rows.position_n_m[at, :2], truth_m))
        assert worst_window_m(places_m, truth_m) < 1.0
    assert min(leaps_m) > 1.2  # in the rows, what was put right shows


@pytest.mark.slow
def test_in_twenty_minutes_no_step_is_put_right_by_the_way_behind() -> None:
    search = find_scenario("search-ground-floor")
    search = msgspec.structs.replace(search, duration_s=1200.0)
    for seed in range(2):
        _, _, places_m, truth_m = walked(Simulation(search, seed, CONSUMER_SENSORS))
        assert worst_window_m(places_m, truth_m) < 0.25


def test_stated_covariance_covers_the_difference_to_the_best_path() -> None:
    rows, t_s, places_m, _ = walked(on_the_move(1, UNCALIBRATED_SENSORS))
    stream = PositionPublisher(HeaderFactory("u1", 1, SystemClock()), RATE_HZ)
    last = stream.push(rows, Timeline())[-1]
    at = np.searchsorted(rows.t_ns - rows.t_ns[0], round(t_s[-1] * NS_PER_S))
    off_m = np.abs(places_m[-1] - rows.position_n_m[at, :2])
    assert off_m.max() > 0.3
    assert last.std_north_m >= off_m[0]
    assert last.std_east_m >= off_m[1]
    assert t_s[-1] > 60.0
