"""Biases that follow the temperature: while a calibration is made, and when it is used."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.calibration.correction import Correction
from edge.calibration.model import Accelerometer, Calibration, Gyroscope, Warmth
from edge.calibration.rest_detector import RestWindow
from edge.calibration.solver import solve_accelerometer, solve_gyroscope
from edge.samples import Floats, ImuBatch, SensorBatch, SensorDescription
from edge.simulation.handled_unit import EDGES, SIDES
from edge.simulation.imu import GRAVITY_MPS2
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import TrackBatch
from shared.clock import ManualClock
from shared.header_factory import HeaderFactory
from tests.rig.calibration_steps import MADE, known
from tests.rig.straight_tracker import StraightAhead, walk

ACCEL_SLOPE, GYRO_SLOPE = np.array([0.010, -0.020, 0.015]), np.array([4e-4, -3e-4, 2e-4])
ACCEL_BIAS, GYRO_BIAS = np.array([0.05, 0.10, -0.08]), np.array([0.010, -0.020, 0.005])
PER_FORCE = 1e-4 * np.array([[1.0, 0.5, -0.4], [-0.6, 0.8, 0.3], [0.2, -0.9, 0.7]])
ZERO, GAIN = (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
SENSOR = SensorDescription("s", 100.0)


def triple(values: Floats) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


WARMTH = Warmth(triple(ACCEL_SLOPE), ZERO, triple(GYRO_SLOPE), ZERO, 10.0, 30.0, 0.0, 0.0)


def rest(up: Floats, degc: float, at_degc: float, rng: np.random.Generator) -> RestWindow:
    """Half a second with the unit's ``up`` upwards; its biases are those above at ``at_degc``."""
    warmer = degc - at_degc
    accel_mps2 = GRAVITY_MPS2 * up + ACCEL_BIAS + ACCEL_SLOPE * warmer
    gyro_radps = GYRO_BIAS + GYRO_SLOPE * warmer + PER_FORCE @ accel_mps2
    return RestWindow(0, accel_mps2, gyro_radps + rng.normal(0.0, 1e-6, 3), degc)


def poses(at_degc: float, rng: np.random.Generator) -> list[RestWindow]:
    """The unit warms by two thirds of a degree from one to the next."""
    ups = np.vstack((SIDES, EDGES)).astype(float)
    ups /= np.linalg.norm(ups, axis=1)[:, None]
    return [rest(up, 14.0 + number / 1.5, at_degc, rng) for number, up in enumerate(ups)]


def test_a_unit_that_warms_while_it_is_turned_over_is_calibrated_all_the_same() -> None:
    rng = np.random.default_rng(1)
    at_degc = float(np.mean([pose.temperature_degc for pose in poses(0.0, rng)]))
    found = solve_accelerometer(poses(at_degc, rng), WARMTH)
    assert found.at_degc == pytest.approx(at_degc)
    assert found.bias_mps2 == pytest.approx(ACCEL_BIAS, abs=1e-3)
    assert np.diag(found.gain) == pytest.approx([1.0, 1.0, 1.0], abs=1e-4)
    assert found.residual_mps2 < 1e-3


def test_the_gyroscope_of_a_unit_that_warms_is_too() -> None:
    rng = np.random.default_rng(2)
    up = np.array([0.0, 0.0, 1.0])
    still = [rest(up, 20.0 + number / 20.0, 20.5, rng) for number in range(21)]
    found = solve_gyroscope(still, poses(20.5, rng), WARMTH)
    assert found.at_degc == pytest.approx(20.5)
    assert found.bias_radps == pytest.approx(GYRO_BIAS, abs=1e-5)
    assert np.array(known(found.per_force)) == pytest.approx(PER_FORCE, abs=1e-6)
    assert found.residual_radps < 1e-5


def test_the_bias_is_as_sure_as_so_many_noisy_readings_make_it() -> None:
    rng = np.random.default_rng(3)
    noise = rng.normal(0.0, 1e-3, (400, 3))
    still = [RestWindow(0, np.array([0.0, 0.0, 9.8]), GYRO_BIAS + one, 20.0) for one in noise]
    found = solve_gyroscope(still, [], None)
    assert found.bias_std_radps == pytest.approx([1e-3 / 20.0] * 3, rel=0.2)
    assert found.residual_radps == pytest.approx(1e-3, rel=0.1)


@pytest.mark.parametrize(
    ("at_degc", "counted_degc"),
    [(20.0, [-10.0, -10.0, 0.0, 8.0, 10.0, 10.0, 0.0]), (40.0, [-30, -30, -20, -12, -10, 0, 0])],
    ids=["within the warm-up", "warmer than it"],
)
def test_beyond_the_warm_up_the_bias_stays_and_without_a_temperature_it_is_the_usual(
    at_degc: float, counted_degc: list[float]
) -> None:
    degc = np.array([-5.0, 10.0, 20.0, 28.0, 30.0, 50.0, np.nan])
    none = np.zeros((len(degc), 3))
    readings = ImuBatch(np.arange(len(degc)), none, none, imu_temperature_degc=degc)
    after = warm_calibration(at_degc).apply(readings, SENSOR)
    counted = np.array(counted_degc)[:, None]
    assert after.accel_mps2 == pytest.approx(-ACCEL_BIAS - counted * ACCEL_SLOPE)
    assert after.gyro_radps == pytest.approx(-GYRO_BIAS - counted * GYRO_SLOPE)


def test_a_unit_that_does_not_tell_its_temperature_is_rid_of_its_biases() -> None:
    none = np.zeros((3, 3))
    after = warm_calibration(20.0).apply(ImuBatch(np.arange(3), none, none), SENSOR)
    assert after.accel_mps2 == pytest.approx(none - ACCEL_BIAS)
    assert after.gyro_radps == pytest.approx(none - GYRO_BIAS)


@pytest.mark.parametrize("at_once", [1, 7, 20])
def test_between_two_readings_of_the_temperature_the_last_one_holds(at_once: int) -> None:
    """An x-IMU3 tells it five times a second, and motion four hundred times."""
    degc = np.full(20, np.nan)
    degc[[3, 11]] = 25.0, 15.0
    none = np.zeros((20, 3))
    readings = ImuBatch(np.arange(20), none, none, imu_temperature_degc=degc)
    correction = Correction(warm_calibration(20.0), SENSOR)
    parts = [
        correction.push(readings.part(slice(first, first + at_once)))
        for first in range(0, 20, at_once)
    ]
    counted = np.repeat([0.0, 5.0, -5.0], [3, 8, 9])[:, None]
    accel_mps2 = np.vstack([part.accel_mps2 for part in parts])
    assert accel_mps2 == pytest.approx(-ACCEL_BIAS - counted * ACCEL_SLOPE)
    gyro_radps = np.vstack([part.gyro_radps for part in parts])
    assert gyro_radps == pytest.approx(-GYRO_BIAS - counted * GYRO_SLOPE)
    reported = np.concatenate([known(part.imu_temperature_degc) for part in parts])
    assert reported.tolist() == pytest.approx(degc.tolist(), nan_ok=True), "as the sensor told it"


def test_batches_of_other_sensors_alone_and_without_a_temperature_are_corrected_too() -> None:
    correction = Correction(warm_calibration(20.0), SENSOR)
    none = np.zeros((3, 3))
    warm = ImuBatch(np.arange(3), none, none, imu_temperature_degc=np.full(3, 25.0))
    assert len(correction.push(warm.part(slice(0, 0)))) == 0
    correction.push(warm)
    assert len(correction.push(warm.part(slice(0, 0)))) == 0
    after = correction.push(replace(warm, imu_temperature_degc=None))
    assert after.accel_mps2 == pytest.approx(none - ACCEL_BIAS)


def test_a_unit_s_tracker_is_given_samples_of_which_the_temperature_has_been_held() -> None:
    class Noting(StraightAhead):
        def push(self, batch: ImuBatch) -> TrackBatch:
            pushed.append(batch.accel_mps2)
            return super().push(batch)

    pushed: list[Floats] = []
    identity = UnitIdentity(
        "1.0", "test", "straight", (FittedSensor(SENSOR, warm_calibration(20.0)),)
    )
    pipe = TrackerPipeline(
        identity, OneSensorTracker(Noting()), HeaderFactory("u1", 7, ManualClock()), 5.0
    )
    for degc in (25.0, np.nan):
        pipe.step(SensorBatch(replace(walk(1), imu_temperature_degc=np.array([degc]))))
    expected = walk(1).accel_mps2 - ACCEL_BIAS - 5.0 * ACCEL_SLOPE
    assert np.vstack(pushed) == pytest.approx(np.vstack((expected, expected)))


def warm_calibration(at_degc: float) -> Calibration:
    return Calibration(
        "u1",
        "s",
        MADE,
        Accelerometer(
            gain=GAIN,
            gain_std=(ZERO, ZERO, ZERO),
            bias_mps2=triple(ACCEL_BIAS),
            bias_std_mps2=ZERO,
            at_degc=at_degc,
            poses=12,
            residual_mps2=0.0,
        ),
        Gyroscope(
            bias_radps=triple(GYRO_BIAS),
            bias_std_radps=ZERO,
            at_degc=at_degc,
            residual_radps=0.0,
        ),
        warmth=WARMTH,
    )
