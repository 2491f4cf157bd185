"""Height from pressure: lifts, ramps and stairs, and changes of the weather."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from edge.simulation.legs import Ride, Stand, Turn, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import walk
from tests.rig.inertial_walk import inertial_walk, samples

SCALE_HEIGHT_M = 8434.0
SEEDS = (0, 1, 2)


def run(description, imu, cuts=()):
    tracker = EskfTracker(description)
    parts = [imu.part(slice(a, b)) for a, b in pairwise([0, *cuts, len(imu)])]
    return join_rows([*(tracker.push(part) for part in parts), tracker.finish()])


@cache
def simulated(name, seed, duration_s):
    """Samples of a scenario and the true depth below its start."""
    found = inertial_walk(name, seed, duration_s=duration_s)
    down_m = found.truth.position_n_m[:, 2]
    return found.description, found.sensed("mag_ut", "pressure_pa"), down_m - down_m[0]


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_a_lift_is_ridden_along(seed):
    description, imu, down_m = simulated("lift", seed, 120.0)
    blind = run(description, replace(imu, pressure_pa=None)).position_n_m[:, 2] - down_m
    rows = run(description, imu)
    error_m = rows.position_n_m[:, 2] - down_m
    assert rms(blind) > 1.5
    assert rms(error_m) < 0.3
    assert abs(error_m[-1]) < 0.4
    normalised = error_m / np.sqrt(rows.position_cov_m2[:, 2, 2] + 0.02**2)
    assert rms(normalised) < 2.0


def error_of(legs, seed):
    scenario = Scenario(name="rides", summary="", legs=legs, building=True, start=(5.0, 5.0))
    simulation = Simulation(scenario, seed)
    imu = samples(simulation, simulation.duration_s)
    down_m = simulation.truth(np.asarray(imu.t_ns * 1e-9, dtype=np.float64)).position_n_m[:, 2]
    rows = run(simulation.description, imu)
    return rows.position_n_m[:, 2] - (down_m - down_m[0]), np.sqrt(rows.position_cov_m2[:, 2, 2])


TO_LIFT, FROM_LIFT = Walk(((7.0, 12.0),)), Walk(((7.0, 20.0),))
RIDES = {
    "ten floors, fast": (Ride(32.0, 3.0), FROM_LIFT, Ride(-32.0, 3.0)),
    "stops on the way": (Ride(3.2), Ride(3.2), Ride(6.4), FROM_LIFT, Ride(-12.8)),
    "turns about in it": (Ride(6.4), Turn(90.0), Stand(3.0), Turn(270.0), Ride(6.4)),
    "slow, hydraulic": (Ride(3.2, 0.3), FROM_LIFT),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", RIDES)
@pytest.mark.parametrize("seed", SEEDS)
def test_rides_of_all_kinds_end_on_their_floor(what, seed):
    error_m, std_m = error_of((Stand(3.0), TO_LIFT, *RIDES[what], FROM_LIFT, Stand(3.0)), seed)
    assert abs(error_m[-1]) < 0.5
    assert abs(error_m[-1]) < 3.0 * std_m[-1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_stairs_are_no_worse_for_it(seed):
    description, imu, down_m = simulated("climbs-stairs", seed, 240.0)
    rows = run(description, imu)
    error_m = rows.position_n_m[:, 2] - down_m
    assert rms(error_m) < 0.15
    assert rms(error_m / np.sqrt(rows.position_cov_m2[:, 2, 2] + 0.02**2)) < 2.0


def walk_in_air(down_m=0.0, *, rise_m=0.0, strides=60, seed=0):
    """A walk, and its samples with the pressure at its height; the air adds ``down_m`` (n,)."""
    made = walk(strides=strides, rise_m=rise_m, seed=seed + 1)
    noise = np.random.default_rng(seed)
    drift_m = np.cumsum(noise.standard_normal(len(made.imu))) * 0.0125 / np.sqrt(200.0)
    stated_m = made.position_n_m[:, 2] + drift_m + down_m
    pressure_pa = 101_325.0 * np.exp(stated_m / SCALE_HEIGHT_M)
    pressure_pa += 1.5 * noise.standard_normal(len(made.imu))
    pressure_pa[np.arange(len(made.imu)) % 8 != 0] = np.nan
    return made, replace(made.imu, pressure_pa=pressure_pa)


@pytest.mark.parametrize("rise_m", [0.025, -0.025, 0.03])
def test_a_ramp_too_gentle_for_the_strides_is_seen(rise_m):
    made, imu = walk_in_air(rise_m=rise_m)
    risen_m = -run(made.description, imu).position_n_m[-1, 2] / (60 * rise_m)
    blind_m = -run(made.description, made.imu).position_n_m[-1, 2] / (60 * rise_m)
    assert blind_m < 0.1
    assert risen_m > 0.5


T_S = np.arange(0.0, 2.0 + 60 * 1.2 + 1.0, 0.005)
AIR = {
    "a front coming in": 0.003 * T_S,
    "a fan switched on": np.where(T_S > 30.0, 3.0, 0.0),
    "a door slammed": 2.0 * np.exp(-np.abs(T_S - 30.3) / 0.4),
    "gusts": 0.3 * np.sin(T_S) * np.sin(0.37 * T_S),
}


@pytest.mark.parametrize("what", AIR)
def test_pressure_change_alone_changes_no_height_on_a_flat_floor(what):
    made, imu = walk_in_air(AIR[what])
    rows = run(made.description, imu)
    assert np.abs(rows.position_n_m[rows.stationary, 2]).max() < 0.1


def test_a_pressure_sensor_that_always_hung_is_not_received():
    made, imu = walk_in_air(rise_m=0.17, strides=20)
    hanging_pa = np.where(np.isnan(imu.pressure_pa), np.nan, 101_325.0)
    hung, deaf = run(made.description, replace(imu, pressure_pa=hanging_pa)), made.imu
    assert np.array_equal(hung.position_n_m, run(made.description, deaf).position_n_m)


def test_a_pressure_sensor_that_begins_to_hang_is_no_longer_believed():
    made, imu = walk_in_air(rise_m=0.17, strides=40)
    hangs = (np.arange(len(imu)) > 2_000) & ~np.isnan(imu.pressure_pa)
    hanging_pa = np.where(hangs, imu.pressure_pa[2_000], imu.pressure_pa)
    risen_m = -run(made.description, replace(imu, pressure_pa=hanging_pa)).position_n_m[-1, 2]
    assert risen_m == pytest.approx(40 * 0.17, abs=0.7)


@pytest.mark.parametrize("value", [np.nan, np.inf, -1.0, 0.0, 1e9])
def test_without_pressure_nothing_changes(value):
    made, imu = walk_in_air(rise_m=0.17, strides=8)
    without = run(made.description, made.imu)
    broken = run(made.description, replace(imu, pressure_pa=np.full(len(imu), value)))
    for field in fields(without):
        assert np.array_equal(getattr(without, field.name), getattr(broken, field.name))


def test_batching_does_not_change_a_bit():
    description, imu, _ = simulated("lift", 0, 120.0)
    first = imu.part(slice(0, 12_000))
    whole = run(description, first)
    cut = run(description, first, cuts=range(7, 12_000, 137))
    for field in fields(whole):
        assert np.array_equal(getattr(whole, field.name), getattr(cut, field.name)), field.name
