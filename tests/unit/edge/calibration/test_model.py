"""Calibrations of simulated sensors find their known errors, and remove them."""

from __future__ import annotations

import numpy as np
import pytest

from edge.calibration.model import Calibration, Gyroscope
from edge.calibration.steps import PosesStep, StillStep, TurningStep, WarmUpStep
from edge.samples import ImuBatch, SensorDescription
from edge.simulation.handled_unit import EDGES, SIDES, HandledUnit
from edge.simulation.imu import GRAVITY_MPS2
from tests.rig.calibration_steps import MADE, gathered, known, solved

SENSOR = SensorDescription("s", 200.0, 156.9, 34.9)
SEEDS = range(6)
X = np.array([1.0, 0.0, 0.0])


def test_the_gyroscope_s_bias_is_found_within_its_standard_deviation():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        step = gathered(StillStep(), [unit.rest(20.0)])
        found = known(solved(step).gyroscope)
        gyro = unit.imu._gyro
        up_s = np.array([0.0, 0.0, -GRAVITY_MPS2])
        true = gyro._bias - gyro._per_degc + gyro._per_force @ up_s  # at 24 degC, lying like this
        walked = gyro._errors.bias_walk * 20.0**0.5
        std = np.hypot(found.bias_std_radps, walked)
        off.append((np.array(found.bias_radps) - true) / std)
    assert np.abs(off).max() < 4.5
    assert np.sqrt(np.mean(np.square(off))) < 1.8


def test_sensitivity_of_the_rate_to_force_is_found():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        found = known(
            solved(
                gathered(StillStep(), [unit.rest(14.0)]),
                gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)]),
            ).gyroscope
        )
        error = np.array(known(found.per_force)) - unit.imu._gyro._per_force
        off.append(error / known(found.per_force_std))
    assert 0.6 < np.sqrt(np.mean(np.square(off))) < 1.8


def test_the_accelerometer_is_found_within_its_standard_deviations():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        step = gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)])
        found = known(solved(step).accelerometer)
        accel = unit.imu._accel
        off.append(
            (np.array(found.bias_mps2) - (accel._bias - accel._per_degc)) / found.bias_std_mps2
        )
        # All but a rotation of the three axes together is undone.
        left = np.array(found.gain) @ accel._gain
        assert np.abs(left.T @ left - np.eye(3)).max() < 5.0 * np.max(found.gain_std)
        assert found.residual_mps2 < 0.005
    assert np.abs(off).max() < 4.0


def test_six_poses_give_scale_and_bias_and_no_misalignment():
    unit = HandledUnit(1)
    found = known(
        solved(gathered(PosesStep(), [*unit.poses(SIDES), unit.turn(X, 1.0)])).accelerometer
    )
    assert np.array(found.gain_std)[0, 1] == 0.0
    true = unit.imu._accel._bias - unit.imu._accel._per_degc
    assert (np.abs(found.bias_mps2 - true) < 3.0 * np.array(found.bias_std_mps2)).all()


def test_poses_that_leave_an_angle_open_give_scale_and_bias_and_no_misalignment():
    """A corner tells of the three angles' sum; angles that fit that alone may be anything."""
    corners = np.array([[1, 1, 1], [-1, -1, -1]])
    unit = HandledUnit(1)
    ups = np.vstack((SIDES, corners, EDGES[[0, 1, 6]], [[-1, 1, 0]]))
    step = gathered(PosesStep(), [*unit.poses(ups), unit.turn(X, 1.0)])
    assert len(step.poses()) == 12
    found = known(solved(step).accelerometer)
    assert np.array(found.gain_std)[0, 1] == 0.0
    assert np.abs(np.array(found.gain) @ unit.imu._accel._gain - np.eye(3)).max() < 0.02


def test_hard_and_soft_iron_are_found_within_their_standard_deviations():
    hard, soft = [], []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        found = known(solved(gathered(TurningStep(), unit.turning(45))).magnetometer)
        hard.append((found.hard_iron_ut - unit.mag._hard_iron_ut) / found.hard_iron_std_ut)
        left = np.array(found.gain) @ unit.mag._soft_iron
        left /= np.cbrt(np.linalg.det(left))
        soft.append((left - np.eye(3)) / np.array(found.gain_std))
        assert found.field_ut == pytest.approx(51.2, rel=0.08)
    assert np.abs(hard).max() < 4.0
    assert np.abs(soft).max() < 5.0


@pytest.mark.slow
def test_the_biases_slopes_with_temperature_are_found():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        warm_up = gathered(WarmUpStep(), unit.warm_up(400.0))
        found = known(solved(warm_up, gathered(StillStep(), [unit.rest(14.0)])).warmth)
        for slope, std, triad in (
            (found.accel_bias_per_degc_mps2, found.accel_std_mps2, unit.imu._accel),
            (found.gyro_bias_per_degc_radps, found.gyro_std_radps, unit.imu._gyro),
        ):
            off.append((np.array(slope) - triad._per_degc) / std)
        assert np.max(found.gyro_std_radps) < 0.5 * unit.imu._gyro._errors.bias_per_degc_std
    assert np.abs(off).max() < 5.0
    assert np.sqrt(np.mean(np.square(off))) < 1.8


def test_a_calibrated_unit_reads_true():
    unit = HandledUnit(4)
    calibration = solved(
        gathered(StillStep(), [unit.rest(20.0)]),
        gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)]),
        gathered(TurningStep(), unit.turning(45)),
        gathered(WarmUpStep(), unit.warm_up(400.0)),
    )
    (cold,) = unit.warm_up(1.0)
    before, after = cold, calibration.apply(cold, unit.description)
    gravity = np.linalg.norm(after.accel_mps2.mean(axis=0))
    assert gravity == pytest.approx(GRAVITY_MPS2, abs=0.01)
    rate = np.linalg.norm(after.gyro_radps.mean(axis=0))
    assert rate < 0.35 * np.linalg.norm(before.gyro_radps.mean(axis=0))
    field = np.linalg.norm(
        np.vstack([calibrated(calibration, b) for b in unit.turning(20)]), axis=1
    )
    assert np.nanstd(field) < 0.02 * np.nanmean(field)
    assert calibration.faults() == ()


def calibrated(calibration, batch):
    mag_ut = calibration.apply(batch, SENSOR).mag_ut
    assert mag_ut is not None
    return mag_ut


def test_a_reading_at_the_end_of_the_range_stays_there():
    gyroscope = Gyroscope(
        bias_radps=(0.5, 0.5, 0.5), bias_std_radps=(0.0, 0.0, 0.0), residual_radps=0.0
    )
    calibration = Calibration("u1", "s", MADE, gyroscope=gyroscope)
    batch = ImuBatch(np.arange(1), np.zeros((1, 3)), np.array([[34.9, -34.8, 1.0]]))
    rates = calibration.apply(batch, SENSOR).gyro_radps
    assert rates.tolist() == [[34.9, -34.8, 0.5]]


def test_a_calibrated_magnetometer_says_what_is_left_and_what_it_showed_of_the_earth():
    unit = HandledUnit(0)
    step = gathered(TurningStep(), unit.turning(45))
    calibration = solved(step)
    described = calibration.described(SENSOR)
    found = known(calibration.magnetometer)
    assert described.mag_earth_ut == found.field_ut
    iron_std_ut = known(described.mag_iron_std_ut)
    assert found.residual_ut <= iron_std_ut < 2.0
    assert iron_std_ut > 0.0
    assert solved(gathered(StillStep(), [unit.rest(20.0)])).described(SENSOR) == SENSOR
