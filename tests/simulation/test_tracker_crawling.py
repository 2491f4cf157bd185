"""A crawling wearer's foot is dragged, and may glide evenly for a moment without standing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.simulation.legs import Crawl, Stand
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import UNCALIBRATED_SENSORS, Simulation
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import GYRO_BIAS, POSITION, SIZE
from edge.tracker.foot.filter.initial_gyro_bias import inflate_bias
from edge.tracker.foot.state import new_filter_state, new_progress
from edge.tracker.foot.zupt.zupt import is_gliding
from edge.tracker.interface import Quality
from edge.tracker.preprocessing.sample_ring import RING
from tests.bench.tracker.walk_errors import track, true_way_m
from tests.bench.tracker.wearers import KINDS, stray
from tests.rig.inertial_walk import inertial_samples

CUT_S = 9.3  # into the crawl
WAY = Crawl(((8.0, 0.0), (8.0, 5.0), (0.0, 5.0), (-4.0, 5.0), (-4.0, 0.0), (4.0, 0.0)))


@pytest.mark.parametrize("seed", [100, 101, 104])
def test_recording_that_starts_while_crawling_has_no_false_stance(seed):
    """The first stances teach the gyroscope's bias; a glide among them taught a wrong one."""
    scenario = Scenario("crawl", "crawls", (Stand(4.0), WAY))
    simulation = Simulation(scenario, seed, UNCALIBRATED_SENSORS)
    first = round(CUT_S * simulation.description.rate_hz)
    imu = inertial_samples(simulation).part(slice(first, None))
    description = replace(simulation.description, mag_present=False, barometer_present=False)
    rows = track(description, imu, "eskf")
    truth = simulation.truth(np.asarray(rows.t_ns * 1e-9, np.float64))
    speed_mps = np.linalg.norm(truth.velocity_n_mps, axis=1)
    assert not np.any(rows.stationary & (speed_mps > 0.5))
    way_m, drift_rad = true_way_m(rows.quaternion_nb, truth)
    assert np.mean(np.abs(drift_rad) <= 2.0 * rows.heading_std_rad) > 0.9
    off_m = np.linalg.norm(rows.position_n_m[:, :2] - way_m[:, :2], axis=1)
    std_m = np.sqrt(np.trace(rows.position_cov_m2[:, :2, :2], axis1=1, axis2=2))
    held = (off_m <= 3.0 * std_m + 0.02) | (rows.quality != Quality.GOOD)
    assert np.mean(held) > 0.95


@pytest.mark.parametrize("seed", [104, 109, 114])
def test_loop_that_is_crawled_from_the_first_sample_on_is_never_silently_wrong(seed):
    """At the loop's end the heading's error moves it by its second and third order alone."""
    kind = next(one for one in KINDS if one.does == "crawls, recorded from mid-crawl on")
    errors = stray(kind, seed, calibrated=False)
    assert abs(errors.heading_rad) > 1.0  # or nothing is tested
    assert errors.silent == 0.0


@pytest.mark.parametrize("seed", [100, 103])
def test_crawl_with_a_data_sheet_sensor_is_held(seed):
    """Its swings are too slow to show the gains, so those of a data sheet turn it."""
    kind = next(one for one in KINDS if one.does == "crawls 34 m")
    errors = stray(kind, seed, calibrated=False)
    assert abs(errors.heading_rad) > 0.25  # or nothing is tested
    assert abs(errors.heading_rad) < 2.0 * errors.heading_std_rad
    assert errors.inside > 0.95


def standing(motion_m2ps4, speed_mps):
    """A ring of one sample, and a filter that is sure of its velocity by a decimetre a second."""
    ring = np.zeros(1, RING)
    ring["motion_m2ps4"], ring["stride_minimum_m2ps4"] = motion_m2ps4, 0.03
    state = new_filter_state()[0]
    for i in range(SIZE):
        state["covariance"][i, i] = 0.1**2
    state["velocity_n_mps"][1] = speed_mps
    return ring.view(np.recarray), state


@pytest.mark.parametrize(
    ("motion_m2ps4", "speed_mps", "is_one"),
    [(0.7, 1.0, True), (0.7, 0.2, False), (0.03, 1.0, False), (0.7, -1.0, True)],
    ids=["is_gliding", "stands nearly", "the stillest of all around", "backwards"],
)
def test_glide_is_detected_only_with_a_known_velocity(motion_m2ps4, speed_mps, is_one):
    ring, state = standing(motion_m2ps4, speed_mps)
    assert is_gliding(ring, new_progress()[0], state, 0, EskfConfig()) is is_one


def test_large_gyroscope_bias_increases_the_unobserved_vertical_effect():
    config = EskfConfig()
    state = new_filter_state()[0]
    state["unobserved_bias_std_radps"] = config.start.data_sheet_bias_std_radps
    state["least_known_axis_b"] = [0.0, 0.0, 1.0]
    for i in range(3):
        state["covariance"][GYRO_BIAS + i, GYRO_BIAS + i] = config.start.gyro_bias_std_radps**2
    state["covariance"][POSITION, GYRO_BIAS + 2] = state["covariance"][GYRO_BIAS + 2, POSITION] = (
        0.2 * config.start.gyro_bias_std_radps**2
    )
    inflate_bias(state, config)
    usual_m = float(state["unobserved_effect"][0])
    state["gyro_bias_radps"] = [0.0, 0.0, 0.05]  # what the vertical shows is not of the level axes
    inflate_bias(state, config)
    assert state["unobserved_effect"][0] == usual_m
    state["gyro_bias_radps"] = [0.04, 0.03, 0.0]
    inflate_bias(state, config)
    assert state["unobserved_effect"][0] == pytest.approx(
        usual_m * 0.05 / np.sqrt(2.0) / config.start.data_sheet_bias_std_radps
    )
