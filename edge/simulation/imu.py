"""Inertial sensors with realistic errors.

The model is the usual one (Groves, "Principles of GNSS, Inertial and Multisensor
Integrated Navigation Systems", 2013, chapter 4): scale and misalignment, turn-on
bias, its random walk and its dependence on temperature, sensitivity of the
gyroscope to specific force, white noise, clipping and quantisation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import radians

import numpy as np

from edge.samples import Floats
from edge.simulation.kinematics import Motion

GRAVITY_MPS2 = 9.80665
_CALIBRATED_AT_DEGC = 25.0


@dataclass(frozen=True, slots=True)
class TriadErrors:
    """Errors of three axes; ``u`` stands for the sensor's unit (m/s^2 or rad/s).  Zeros: ideal."""

    noise_density: float = 0.0  # u / sqrt(Hz)
    bias_std: float = 0.0  # u, drawn once
    bias_walk: float = 0.0  # u / sqrt(s)
    bias_per_degc_std: float = 0.0  # u / K, drawn once
    scale_std: float = 0.0  # drawn once an axis
    misalignment_std_rad: float = 0.0  # drawn once a pair of axes
    g_sensitivity_std: float = 0.0  # u / (m/s^2), drawn once; gyroscopes only
    full_scale: float = np.inf  # u
    resolution: float = 0.0  # u


@dataclass(frozen=True, slots=True)
class ImuErrors:
    accel: TriadErrors
    gyro: TriadErrors
    gain_std: float | None = None  # of scale and axes by a calibration, 1 sigma; None: unknown


IDEAL_IMU = ImuErrors(TriadErrors(), TriadErrors(), gain_std=0.0)

# Data-sheet noise of the consumer class (BMI270, ICM-42688, LSM6DSO); scale and axes as they are
# left by a calibration at the bench.
CONSUMER_IMU = ImuErrors(
    accel=TriadErrors(
        noise_density=1.5e-3,
        bias_std=0.10,
        bias_walk=1e-4,
        bias_per_degc_std=2e-3,
        scale_std=0.002,
        misalignment_std_rad=radians(0.12),
        full_scale=16 * GRAVITY_MPS2,
        resolution=32 * GRAVITY_MPS2 / 2**16,
    ),
    gyro=TriadErrors(
        noise_density=radians(0.007),
        bias_std=radians(0.3),
        bias_walk=radians(0.0005),
        bias_per_degc_std=radians(0.005),
        scale_std=0.002,
        misalignment_std_rad=radians(0.12),
        g_sensitivity_std=radians(0.005),
        full_scale=radians(2000),
        resolution=radians(4000) / 2**16,
    ),
    gain_std=0.002,
)

# The same class as it leaves the factory and is soldered: data-sheet tolerances of zero offset,
# sensitivity, cross-axis and temperature.
UNCALIBRATED_IMU = ImuErrors(
    accel=replace(
        CONSUMER_IMU.accel,
        bias_std=0.3,
        bias_per_degc_std=5e-3,
        scale_std=0.01,
        misalignment_std_rad=radians(0.5),
    ),
    gyro=replace(
        CONSUMER_IMU.gyro,
        bias_std=radians(1.0),
        bias_per_degc_std=radians(0.02),
        scale_std=0.005,
        misalignment_std_rad=radians(0.5),
        g_sensitivity_std=radians(0.02),
    ),
)


class Triad:
    """Three-axis sensor; keeps its bias from call to call."""

    def __init__(self, errors: TriadErrors, rate_hz: float, rng: np.random.Generator) -> None:
        self._errors = errors
        self._rate_hz = rate_hz
        self._rng = rng
        self._bias = rng.normal(0.0, 1.0, 3) * errors.bias_std
        self._per_degc = rng.normal(0.0, 1.0, 3) * errors.bias_per_degc_std
        scale = np.diag(rng.normal(0.0, 1.0, 3) * errors.scale_std)
        skew = rng.normal(0.0, 1.0, (3, 3)) * errors.misalignment_std_rad
        self._gain = np.eye(3) + scale + skew - np.diag(np.diag(skew))
        self._per_force = rng.normal(0.0, 1.0, (3, 3)) * errors.g_sensitivity_std

    def measure(self, true: Floats, force_mps2: Floats, temperature_degc: Floats) -> Floats:
        """Return the readings (n, 3) where ``true`` (m, 3) is; all in sensor axes.

        ``m`` is a multiple of the ``n`` temperatures: the converter is faster than the readings,
        each of which is the mean of as many conversions, clipped one by one.
        """
        errors, count = self._errors, len(temperature_degc)
        conversions = len(true) // count
        steps = self._rng.normal(0.0, 1.0, (count, 3)) * (errors.bias_walk / self._rate_hz**0.5)
        bias = self._bias + np.cumsum(steps, axis=0)
        self._bias = bias[-1]
        warmth = (temperature_degc - _CALIBRATED_AT_DEGC)[:, None]
        noise = self._rng.normal(0.0, 1.0, (count, 3))
        reading = (
            true @ self._gain.T
            + np.repeat(bias, conversions, axis=0)
            + np.repeat(warmth * self._per_degc, conversions, axis=0)
            + force_mps2 @ self._per_force.T
            + np.repeat(noise * (errors.noise_density * self._rate_hz**0.5), conversions, axis=0)
        )
        reading = np.clip(reading, -errors.full_scale, errors.full_scale)
        if conversions > 1:
            reading = reading.reshape(count, conversions, 3).mean(axis=1)
        if errors.resolution:
            reading = np.rint(reading / errors.resolution) * errors.resolution
        return np.asarray(reading, dtype=np.float64)


class Imu:
    """Accelerometer and gyroscope, mounted at any angle on a body."""

    def __init__(
        self, errors: ImuErrors, rotation_bs: Floats, rate_hz: float, rng: np.random.Generator
    ) -> None:
        self._rotation_bs = rotation_bs  # sensor axes to body axes
        self._accel = Triad(errors.accel, rate_hz, rng)
        self._gyro = Triad(errors.gyro, rate_hz, rng)

    def measure(self, motion: Motion, temperature_degc: Floats) -> tuple[Floats, Floats]:
        """Specific force and angular rate (n, 3), sensor axes, of ``n`` temperatures.

        The motion is that at every conversion, one or more a reading.
        """
        accel_n = motion.accel_n_mps2.copy()
        accel_n[:, 2] -= GRAVITY_MPS2
        force_b = np.einsum("nji,nj->ni", motion.rotation_nb, accel_n)
        force_s = force_b @ self._rotation_bs
        rate_s = motion.rate_b_radps @ self._rotation_bs
        return (
            self._accel.measure(force_s, force_s, temperature_degc),
            self._gyro.measure(rate_s, force_s, temperature_degc),
        )
