"""The gyroscope's bias follows the sensor's temperature once two rests have shown the slope."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from edge.samples import ImuBatch
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import walk

PER_K_RADPS = np.array([1e-4, -1.5e-4, 2e-4])
MADE = walk(strides=40)


def warmed() -> ImuBatch:
    """Two minutes of rest from 15 to 35 degrees, the walk, cooling back to 25."""
    imu = MADE.imu
    rest = 24_000
    count = rest + len(imu)
    degc = np.concatenate((np.linspace(15.0, 35.0, rest), np.linspace(35.0, 25.0, len(imu))))
    noise = np.random.default_rng(3)
    gyro = np.vstack((np.zeros((rest, 3)), imu.gyro_radps))
    gyro += (degc - 15.0)[:, None] * PER_K_RADPS + noise.normal(0.0, 1e-3, (count, 3))
    accel = np.vstack((np.tile(imu.accel_mps2[0], (rest, 1)), imu.accel_mps2))
    accel += noise.normal(0.0, 0.02, (count, 3))
    t_ns = np.arange(count, dtype=np.int64) * 5_000_000
    return ImuBatch(t_ns, accel, gyro, imu_temperature_degc=degc)


def run(imu):
    tracker = EskfTracker(MADE.description)
    rows = join_rows([tracker.push(imu), tracker.finish()])
    return tracker._state[0], rows


def test_temperature_slope_is_estimated_at_rest_and_applied_while_walking():
    imu = warmed()
    state, rows = run(imu)
    np.testing.assert_allclose(state["gyro_bias_per_k"], PER_K_RADPS, atol=1e-5)
    blind_state, blind = run(replace(imu, imu_temperature_degc=None))
    off_radps = np.linalg.norm(state["gyro_bias_radps"] - 10.0 * PER_K_RADPS)
    blind_off_radps = np.linalg.norm(blind_state["gyro_bias_radps"] - 10.0 * PER_K_RADPS)
    assert off_radps < 0.5 * blind_off_radps
    assert rows.heading_std_rad[-1] < blind.heading_std_rad[-1]


def test_invalid_temperature_changes_nothing():
    imu = warmed()
    _, without = run(replace(imu, imu_temperature_degc=None))
    nonsense = np.where(np.arange(len(imu)) % 2, np.nan, -273.0)
    _, rows = run(replace(imu, imu_temperature_degc=nonsense))
    assert np.array_equal(rows.position_n_m, without.position_n_m)
    assert np.array_equal(rows.position_cov_m2, without.position_cov_m2)
