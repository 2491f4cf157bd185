"""Calibration: a sensor's errors are found by turning it, and undone in any batching."""

from __future__ import annotations

from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from edge.calibration.model import Accelerometer, Calibration, Gyroscope, Magnetometer, Warmth
from edge.calibration.solver import matrix as to_matrix
from edge.calibration.sphere_fit import SYMMETRIC, TRIANGULAR, fit_sphere
from edge.samples import ImuBatch, SensorDescription

share = st.floats(-0.08, 0.08)
vector = st.tuples(share, share, share)
matrix = st.tuples(vector, vector, vector)
SENSOR = SensorDescription("s", 100.0, 100.0, 30.0)


def directions(count: int, seed: int):
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


@given(distortion=matrix, bias=vector, seed=st.integers(0, 999))
@settings(max_examples=60)
def test_ellipsoid_is_calibrated_to_its_sphere(distortion, bias, seed):
    gain = np.eye(3) + np.array(distortion)
    readings = directions(40, seed) @ gain.T + np.array(bias)
    for shape in (TRIANGULAR, SYMMETRIC):
        fit = fit_sphere(readings, shape, np.eye(3), np.zeros(3), 1e-6)
        assert fit.residual < 1e-6
        assert np.abs(fit.centre - bias).max() < 1e-5
        left = fit.gain @ gain
        assert np.abs(left.T @ left - np.eye(3)).max() < 1e-5


@given(distortion=matrix, bias=vector, cuts=st.lists(st.integers(0, 60), max_size=4))
@settings(max_examples=40)
def test_each_sample_is_calibrated_alone(distortion, bias, cuts):
    rng = np.random.default_rng(1)
    gain = to_matrix(np.eye(3) + np.array(distortion))
    zero = (0.0, 0.0, 0.0)
    zeros = (zero, zero, zero)
    calibration = Calibration(
        unit="u", sensor="s", made=datetime(2026, 1, 1, tzinfo=UTC),
        accelerometer=Accelerometer(
            gain=gain, gain_std=zeros, bias_mps2=bias, bias_std_mps2=zero, at_degc=20.0, poses=6,
            residual_mps2=0.0,
        ),
        gyroscope=Gyroscope(
            bias_radps=bias, bias_std_radps=zero, per_force=gain, at_degc=20.0,
            residual_radps=0.0,
        ),
        magnetometer=Magnetometer(
            gain=gain, gain_std=zeros, hard_iron_ut=bias, hard_iron_std_ut=zero, field_ut=50.0,
            residual_ut=0.0,
        ),
        warmth=Warmth(
            accel_bias_per_degc_mps2=bias, accel_std_mps2=zero, gyro_bias_per_degc_radps=bias,
            gyro_std_radps=zero, from_degc=10.0, to_degc=30.0, residual_mps2=0.0,
            residual_radps=0.0,
        ),
    )  # fmt: skip
    degc = rng.uniform(0.0, 40.0, 60)
    degc[::7] = np.nan
    whole = ImuBatch(
        np.arange(60), rng.normal(size=(60, 3)), rng.normal(size=(60, 3)),
        mag_ut=rng.normal(size=(60, 3)), imu_temperature_degc=degc,
    )  # fmt: skip
    before = whole.accel_mps2.copy()
    at_once = calibration.apply(whole, SENSOR)
    edges = sorted({0, 60, *cuts})
    parts = [
        calibration.apply(whole.part(slice(start, stop)), SENSOR) for start, stop in pairwise(edges)
    ]
    for column in ("accel_mps2", "gyro_radps", "mag_ut"):
        joined = np.vstack([getattr(part, column) for part in parts])
        assert joined.tobytes() == getattr(at_once, column).tobytes()
        assert np.isfinite(joined).all()
    assert whole.accel_mps2.tobytes() == before.tobytes()
