"""A start on the move with a large gyroscope bias is reported, and corrected by a rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import UNCALIBRATED_SENSORS, Simulation
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import GYRO_BIAS, SIZE
from edge.tracker.foot.filter.initial_gyro_bias import update_from_rest
from edge.tracker.foot.state import new_filter_state
from edge.tracker.interface import Quality, Reason
from tests.bench.tracker.scoring import CHI2_95_2DOF, horizontal_nees
from tests.bench.tracker.walk_errors import track, true_way_m
from tests.rig.inertial_walk import inertial_samples

RATE_HZ = 200
WALKED_S = 4.0  # when the recording begins, a second into the walk
LEGS = (
    Stand(3.0),
    Walk(((20.0, 0.0), (20.0, 20.0), (0.0, 20.0))),
    Stand(4.0),
    Walk(((0.0, 40.0),)),
    Stand(2.0),
)


def walked(seed, bias_radps, legs=LEGS):
    """Rows, true way and heading drift by a gyroscope that is off about the vertical."""
    gyro = replace(UNCALIBRATED_SENSORS.imu.gyro, bias_std=0.0)
    sensors = replace(UNCALIBRATED_SENSORS, imu=replace(UNCALIBRATED_SENSORS.imu, gyro=gyro))
    simulation = Simulation(Scenario("late", "starts late", legs), seed, sensors)
    imu = inertial_samples(simulation).part(slice(round(WALKED_S * RATE_HZ), None))
    down_b = simulation.truth(np.zeros(1)).rotation_nb[0, 2]
    imu = ImuBatch(imu.t_ns, imu.accel_mps2, imu.gyro_radps + bias_radps * down_b)
    description = replace(simulation.description, mag_present=False, barometer_present=False)
    rows = track(description, imu, "eskf")
    truth = simulation.truth(np.asarray(rows.t_ns * 1e-9, np.float64))
    way_m, drift_rad = true_way_m(rows.quaternion_nb, truth)
    return rows, way_m, drift_rad


@pytest.mark.parametrize("bias_deg", [1.0, -2.0])
def test_start_in_motion_has_a_stated_heading_uncertainty(bias_deg):
    stated = []
    for seed in range(6):
        rows, way_m, _ = walked(seed, np.radians(bias_deg))
        walking = slice(0, len(rows) // 2, 20)
        nees = horizontal_nees(
            rows.position_n_m[walking], way_m[walking], rows.position_cov_m2[walking]
        )
        flagged = rows.quality[walking] != Quality.GOOD
        stated.append(np.mean(flagged | (nees <= CHI2_95_2DOF)))
        assert np.degrees(rows.heading_std_rad[len(rows) // 2]) > 12.0
    assert np.mean(stated) > 0.85


def test_first_rest_corrects_the_bias_and_the_heading():
    rows, _, drift_rad = walked(1, np.radians(3.0))
    rests = np.flatnonzero(rows.stationary & (rows.t_ns > 45e9))
    before, after = drift_rad[rests[0]], drift_rad[-1]
    assert abs(before) > np.radians(40.0)
    assert abs((after + np.pi) % (2.0 * np.pi) - np.pi) < np.radians(25.0)
    assert np.degrees(rows.heading_std_rad[-1]) < 25.0


def test_rest_before_the_walk_determines_the_bias():
    simulation = Simulation(Scenario("rested", "stands first", LEGS), 1, UNCALIBRATED_SENSORS)
    rows = track(simulation.description, inertial_samples(simulation), "eskf")
    assert np.degrees(rows.heading_std_rad[round(3.0 * RATE_HZ)]) < 1.0
    assert not unsettled(rows).any()


@pytest.mark.parametrize("seed", range(3))
def test_start_in_motion_requests_a_rest_until_one_is_observed(seed):
    rows, _, _ = walked(seed, np.radians(0.5))
    reported = unsettled(rows)
    strides = np.flatnonzero(~rows.stationary)
    stands = strides[np.diff(strides, append=0) > 3.0 * RATE_HZ][0]
    assert reported[round(10.0 * RATE_HZ) : stands].all()
    assert not reported[stands + round(5.0 * RATE_HZ) :].any()


def unsettled(rows):
    return (rows.reasons & Reason.UNSETTLED) != 0


def test_swaying_foot_is_no_rest():
    """Recorded feet that twist slowly in stance scatter by half of their mean rate at least."""
    config = EskfConfig()
    state = new_filter_state()[0]
    for i in range(SIZE):
        state["covariance"][i, i] = config.start.gyro_bias_std_radps**2
    before = state["covariance"].copy()
    state["rest_rate_radps"][2] = 0.03
    state["rest_rate_var_rad2ps2"] = (0.5 * 0.03) ** 2
    update_from_rest(state, config)
    assert np.array_equal(state["covariance"], before)
    state["rest_rate_var_rad2ps2"] = (0.02 * 0.03) ** 2
    update_from_rest(state, config)
    assert state["covariance"][GYRO_BIAS + 2, GYRO_BIAS + 2] > 0.03**2
