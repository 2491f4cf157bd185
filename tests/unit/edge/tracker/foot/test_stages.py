"""The compiled filter against the same filter in plain NumPy."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from edge.samples import SensorDescription
from edge.tracker.foot import eskf
from edge.tracker.foot.config import EskfConfig, FloorConfig, ProcessNoiseConfig, ZuptConfig
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    LEVER,
    SIZE,
    TURN,
    VELOCITY,
)
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.foot.filter.alignment import level
from edge.tracker.foot.filter.integration import mean_readings
from edge.tracker.foot.state import new_filter_state
from edge.tracker.foot.zupt.zupt import MIN_INTERVAL_S, stance_velocity_noise
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.preprocessing.sample_ring import new_ring
from tests.bench.tracker.reference_filter import PlainFilter
from tests.rig.exact_strides import walk

# Without the floor's correction, and with every rate update used.
CONFIG = EskfConfig(
    floor=FloorConfig(
        gate_m=0.0, gate_slope=0.0, gate_stds=0.0, rise_bias_std_m=0.0, rise_bias_per_gain_m=0.0
    ),
    zupt=ZuptConfig(stance_rate_gain_min_hz=0.0),
    # Follows the landings, which the plain filter does not.
    process=ProcessNoiseConfig(curvature_noise_per_strike=0.0),
)
WALK = walk(strides=4, gyro_bias_radps=(0.002, -0.003, 0.001), accel_bias_mps2=(0.05, 0.1, -0.1))


def start(ring):
    """The plain filter as the tracker starts its own."""
    quaternion, rotation = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros((3, 3))
    ahead_s = CONFIG.timing.lookahead_s + CONFIG.timing.lag_s
    tilt_std_rad = level(ring, 0, len(WALK.imu), ahead_s, CONFIG, quaternion)
    rotation_matrix(quaternion, rotation)
    std = np.zeros(SIZE)
    std[VELOCITY : VELOCITY + 3] = CONFIG.start.still_std_mps
    std[ATTITUDE : ATTITUDE + 2] = tilt_std_rad
    std[GYRO_BIAS : GYRO_BIAS + 3] = CONFIG.start.gyro_bias_std_radps
    std[ACCEL_BIAS : ACCEL_BIAS + 3] = CONFIG.start.accel_bias_std_mps2
    std[LEVER : LEVER + 3] = CONFIG.start.lever_std_m
    std[GYRO_BIAS_PER_K : GYRO_BIAS_PER_K + 3] = CONFIG.process.gyro_bias_per_k_std_radps
    return PlainFilter(rotation, np.diag(std**2), CONFIG)


def stance_variances(ring, k):
    interval_s = max(ring[k]["interval_s"], MIN_INTERVAL_S)
    rate_noise = CONFIG.zupt.stance_rate_radps_rthz**2
    rate_noise += CONFIG.zupt.stance_rate_per_unrest**2 * ring[k]["unrest_m2ps4"] ** 3
    velocity_noise = stance_velocity_noise(ring, k, ring[k]["motion_m2ps4"], CONFIG)
    return velocity_noise / interval_s, rate_noise / interval_s


@pytest.mark.slow
def test_both_come_to_the_same_state(monkeypatch):
    # A ring that holds every sample at the end.
    monkeypatch.setattr(eskf, "new_ring", partial(new_ring, span_s=5.0))
    tracker = EskfTracker(SensorDescription("plain", 200.0), CONFIG)
    tracker.push(WALK.imu)
    tracker.finish()
    ring, state = tracker._ring, tracker._state[0]
    plain = start(ring)
    means = new_filter_state()[0]  # its biases stay zero
    for k in range(len(WALK.imu)):
        if k:
            mean_readings(ring, tracker._progress[0], means, k, CONFIG)
            plain.predict(
                means["accel_mps2"],
                means["gyro_radps"],
                ring[k]["interval_s"],
                (0.0, means["gyro_curvature_var"]),
            )
        if ring[k]["stationary"]:
            plain.apply_zupt(ring[k]["gyro_radps"], *stance_variances(ring, k))
    assert np.linalg.norm(plain.position_n_m[:2]) > 5.0
    np.testing.assert_allclose(state["position_n_m"], plain.position_n_m, atol=1e-6)
    np.testing.assert_allclose(state["velocity_n_mps"], plain.velocity_n_mps, atol=1e-6)
    np.testing.assert_allclose(state["rotation_nb"], plain.rotation_nb, atol=1e-6)
    np.testing.assert_allclose(state["gyro_bias_radps"], plain.gyro_bias_radps, atol=1e-8)
    np.testing.assert_allclose(state["accel_bias_mps2"], plain.accel_bias_mps2, atol=1e-6)
    np.testing.assert_allclose(state["lever_b_m"], plain.lever_b_m, atol=1e-6)
    covariance = state["covariance"].copy()
    covariance[TURN, TURN] = 0.0  # kept for a compass; see gain_errors
    np.testing.assert_allclose(covariance, plain.covariance, rtol=1e-4, atol=1e-9)
