"""Simulated inertial sensors: each error has its own effect, and no other."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import Floats
from edge.simulation.imu import GRAVITY_MPS2, IDEAL_IMU, Imu, Triad, TriadErrors
from edge.simulation.kinematics import Motion

RATE_HZ = 200.0
WARM = 25.0


def measure(errors: TriadErrors, true: Floats, warmth_degc: float = 0.0, seed: int = 1) -> Floats:
    triad = Triad(errors, RATE_HZ, np.random.default_rng(seed))
    force = np.tile([0.0, 0.0, -GRAVITY_MPS2], (len(true), 1))
    return triad.measure(true, force, np.full(len(true), WARM + warmth_degc))


def resting(rotation_nb: Floats, count: int = 1) -> Motion:
    zero = np.zeros((count, 3))
    return Motion(
        np.arange(count) / RATE_HZ, zero, zero, zero, np.tile(rotation_nb, (count, 1, 1)), zero
    )


def test_a_level_sensor_at_rest_shows_gravity_upward() -> None:
    imu = Imu(IDEAL_IMU, np.eye(3), RATE_HZ, np.random.default_rng(0))
    accel, gyro = imu.measure(resting(np.eye(3)), np.array([WARM]))
    assert accel[0] == pytest.approx([0.0, 0.0, -GRAVITY_MPS2])
    assert gyro[0] == pytest.approx([0.0, 0.0, 0.0])


def test_a_mount_turns_what_the_sensor_sees() -> None:
    # The sensor's x axis points along the body's down axis.
    rotation_bs = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    imu = Imu(IDEAL_IMU, rotation_bs, RATE_HZ, np.random.default_rng(0))
    accel, _ = imu.measure(resting(np.eye(3)), np.array([WARM]))
    assert accel[0] == pytest.approx([-GRAVITY_MPS2, 0.0, 0.0])


def test_noise_density_gives_the_noise_of_the_rate() -> None:
    noise = measure(TriadErrors(noise_density=0.01), np.zeros((20_000, 3)))
    assert noise.std() == pytest.approx(0.01 * np.sqrt(RATE_HZ), rel=0.02)
    assert abs(noise.mean()) < 5 * 0.01 * np.sqrt(RATE_HZ) / np.sqrt(noise.size)


def test_turn_on_bias_is_constant_and_differs_between_units() -> None:
    errors = TriadErrors(bias_std=0.1)
    reported = np.array([measure(errors, np.zeros((5, 3)), seed=seed) for seed in range(300)])
    assert np.ptp(reported, axis=1).max() == 0.0
    assert reported[:, 0].std() == pytest.approx(0.1, rel=0.1)


def test_bias_walk_grows_with_the_square_root_of_time_across_calls() -> None:
    ends = []
    for seed in range(300):
        triad = Triad(TriadErrors(bias_walk=0.01), RATE_HZ, np.random.default_rng(seed))
        zero = np.zeros((400, 3))
        first = triad.measure(zero, zero, np.full(400, WARM))
        second = triad.measure(zero, zero, np.full(400, WARM))
        assert np.abs(second[0] - first[-1]).max() < 0.005, "the bias goes on where it was"
        ends.append(second[-1])
    assert np.std(ends) == pytest.approx(0.01 * np.sqrt(800 / RATE_HZ), rel=0.1)


def test_scale_misalignment_temperature_and_g_sensitivity() -> None:
    ones = np.ones((1, 3))
    zero = np.zeros((1, 3))
    assert np.abs(measure(TriadErrors(scale_std=0.01), zero)).max() == 0.0
    assert 0.0 < np.abs(measure(TriadErrors(scale_std=0.01), ones) - 1.0).max() < 0.05
    skewed = measure(TriadErrors(misalignment_std_rad=0.01), np.array([[1.0, 0.0, 0.0]]))
    assert skewed[0, 0] == 1.0
    assert np.abs(skewed[0, 1:]).min() > 0.0
    warm = TriadErrors(bias_per_degc_std=0.01)
    assert measure(warm, zero, 20.0) == pytest.approx(2.0 * measure(warm, zero, 10.0))
    assert np.abs(measure(warm, zero, 0.0)).max() == 0.0
    assert np.abs(measure(TriadErrors(g_sensitivity_std=0.01), zero)).max() > 0.0


def test_a_reading_is_the_mean_of_clipped_conversions() -> None:
    spikes = np.zeros((8, 3))
    spikes[2] = 9.0
    triad = Triad(TriadErrors(full_scale=2.0), RATE_HZ, np.random.default_rng(0))
    readings = triad.measure(spikes, np.zeros((8, 3)), np.full(2, WARM))
    assert readings == pytest.approx(np.array([[0.5] * 3, [0.0] * 3]))


def test_clipping_and_quantisation() -> None:
    ramp = np.repeat(np.linspace(-3.0, 3.0, 601)[:, None], 3, axis=1)
    clipped = measure(TriadErrors(full_scale=2.0), ramp)
    assert (clipped.min(), clipped.max()) == (-2.0, 2.0)
    stepped = measure(TriadErrors(resolution=0.25), ramp)
    assert np.abs(stepped - ramp).max() <= 0.125 + 1e-12
    assert set(np.unique(stepped * 4.0 % 1.0)) == {0.0}
