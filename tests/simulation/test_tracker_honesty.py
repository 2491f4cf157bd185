"""Stated uncertainty on simulated walks is true: by good sensors and by poor ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.simulation.factory import find_scenario
from edge.simulation.imu import GRAVITY_MPS2
from edge.simulation.legs import Crawl, Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import CONSUMER_SENSORS, Simulation
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import Reason
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.honesty import (
    Honesty,
    ending,
    ending_of,
    honesty_table,
    nees_bounds,
)
from tests.bench.tracker.walk_errors import rms, track
from tests.rig.exact_strides import walk
from tests.rig.inertial_walk import inertial_samples

SEEDS = range(12)
NEES_BOUNDS = nees_bounds(len(SEEDS))
# Of the root mean square of twelve standard normal values: sqrt(chi2(12) / 12).
RATIO_BOUNDS = (0.606, 1.394)


@pytest.mark.parametrize("name", ["straight", "square of 60 m", "J-shape", "stairs"])
def test_errors_of_a_calibrated_sensor_agree_with_the_covariance(name):
    endings = [ending(name, seed, calibrated=True) for seed in SEEDS]
    assert NEES_BOUNDS[0] < np.mean([one.nees for one in endings]) < NEES_BOUNDS[1]
    ratio = rms(np.array([one.heading_rad / one.heading_std_rad for one in endings]))
    assert RATIO_BOUNDS[0] < ratio < RATIO_BOUNDS[1]


def test_uncalibrated_sensor_is_not_overconfident():
    """Biases of 1 deg/s, axes off by half a degree: it may be stated too cautiously."""
    for name in ("straight", "J-shape"):
        endings = [ending(name, seed, calibrated=False) for seed in SEEDS]
        assert np.mean([one.nees for one in endings]) < NEES_BOUNDS[1]
        assert np.mean([one.inside for one in endings]) > 0.9
        assert rms(np.array([one.heading_rad for one in endings])) < np.radians(20.0)


def test_gains_unobservable_in_a_long_walk_are_in_the_covariance():
    """Strides that are alike for a lap teach the filter's biases what gains do to them."""
    endings = [ending("track of 400 m", seed, calibrated=False) for seed in range(6)]
    assert np.mean([one.nees for one in endings]) < nees_bounds(6)[1]
    assert np.mean([one.inside for one in endings]) > 0.92


@pytest.mark.parametrize("bias_radps", [0.005, 0.03, 0.06])
def test_gyroscope_reading_at_rest_is_taken_as_its_bias(bias_radps):
    made = walk(strides=8, gyro_bias_radps=(0.3 * bias_radps, -bias_radps, 0.6 * bias_radps))
    rows = track(made.description, made.imu, "eskf")
    assert np.linalg.norm(rows.position_n_m[-1, :2]) == pytest.approx(8 * 1.3, rel=0.02)
    turned_rad = np.arctan2(rows.position_n_m[-1, 1], rows.position_n_m[-1, 0])
    assert abs(turned_rad) < 0.02 + 2.5 * bias_radps  # it turned while the bias was unknown


def test_uncertainty_of_a_gap_is_not_reduced_by_a_good_landing():
    made = walk(strides=20)
    missing = np.ones(len(made.imu), np.bool_)
    missing[2000:2200] = False
    cut = replace(
        made.imu,
        t_ns=made.imu.t_ns[missing],
        accel_mps2=made.imu.accel_mps2[missing],
        gyro_radps=made.imu.gyro_radps[missing],
    )
    rows = track(made.description, cut, "eskf")
    assert np.sqrt(rows.position_cov_m2[1990, 0, 0]) < 0.3
    assert np.sqrt(rows.position_cov_m2[-1, 0, 0]) > 1.4  # 1.5 m/s for a second


@pytest.mark.parametrize("seed", range(2))
def test_doubt_of_a_turn_in_a_gap_does_not_shrink_by_walking_on(seed):
    """Stances seem to show the heading: of 23 degrees the filter itself leaves 11."""
    simulation = Simulation(find_scenario("j-shape"), seed, CONSUMER_SENSORS)
    imu = inertial_samples(simulation)
    since_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
    cut = imu.part(slice(0, int(np.searchsorted(since_s, 8.0))))
    rest = imu.part(slice(int(np.searchsorted(since_s, 8.4)), None))
    tracker = EskfTracker(simulation.description)
    rows = join_rows([tracker.push(cut), tracker.push(rest), tracker.finish()])
    after = int(np.searchsorted(rows.t_ns, imu.t_ns[0] + 10_500_000_000))
    assert rows.heading_std_rad[after] > 0.35
    assert rows.heading_std_rad[-1] >= rows.heading_std_rad[after]


def test_hang_is_doubted_more_than_the_samples_that_are_left_out_for_it():
    """Before it is known, 50 ms of what the gyroscope repeats are taken for motion."""
    simulation = Simulation(find_scenario("j-shape"), 0, CONSUMER_SENSORS)
    imu = inertial_samples(simulation)
    since_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
    first, known, stop = np.searchsorted(since_s, [8.0, 8.05, 8.09])  # while the foot swings
    hung_radps = imu.gyro_radps.copy()
    hung_radps[first:stop] = hung_radps[first]
    lost = np.ones(len(imu), np.bool_)
    lost[known + 1 : stop] = False
    hung = track(simulation.description, replace(imu, gyro_radps=hung_radps), "eskf")
    left_out = track(
        simulation.description,
        ImuBatch(imu.t_ns[lost], imu.accel_mps2[lost], imu.gyro_radps[lost]),
        "eskf",
    )
    assert hung.heading_std_rad[-1] > 1.1 * left_out.heading_std_rad[-1]


def test_table_names_the_simulated_sensors():
    table = honesty_table([Honesty("straight", False, 24, 1.0, 2.0, 0.5, 1.9, 0.95)])
    assert [next(iter(column.cells)) for column in table.columns] == [
        "straight", "data sheet", "1.0", "2.0", "0.50", "1.90", "1.28-2.88", "95",
    ]  # fmt: skip


def test_bounds_agree_with_the_chi_square_distribution():
    """By a table of it: chi2(24) / 12 and chi2(200) / 100."""
    assert nees_bounds(12) == pytest.approx((12.401 / 12, 39.364 / 12), abs=0.01)
    assert nees_bounds(100) == pytest.approx((162.728 / 100, 241.058 / 100), abs=0.001)


@pytest.mark.parametrize("rate_hz", [60.0, 200.0])
def test_crawling_is_not_overconfident(rate_hz):
    """The toes drag and the foot hardly turns; no stride of a crawl is an ordinary one."""
    way = Crawl(((8.0, 0.0), (8.0, 4.0), (0.0, 4.0), (0.0, 0.0)))
    scenario = Scenario("crawl", "crawls", (Stand(4.0), way, Stand(3.0)), rate_hz=rate_hz)
    endings = [ending_of(Simulation(scenario, seed)) for seed in range(6)]
    assert np.mean([one.inside for one in endings]) > 0.9
    assert max(one.error_m for one in endings) < 1.0


def test_a_clipped_force_is_bridged():
    """An accelerometer of 8 g on a sprinter: without the bridge the way is short by a sixth."""
    accel = replace(CONSUMER_SENSORS.imu.accel, full_scale=8.0 * GRAVITY_MPS2)
    sensors = replace(CONSUMER_SENSORS, imu=replace(CONSUMER_SENSORS.imu, accel=accel))
    legs = (Stand(4.0), Walk(((60.0, 0.0),), pace="sprint"), Stand(3.0))
    simulation = Simulation(Scenario("sprint", "sprints", legs), 1, sensors)
    rows = track(simulation.description, inertial_samples(simulation), "eskf")
    assert np.linalg.norm(rows.position_n_m[-1, :2]) == pytest.approx(60.0, rel=0.1)
    assert np.mean(rows.reasons & Reason.ACCEL_SATURATED != 0) > 0.2
