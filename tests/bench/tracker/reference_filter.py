"""The default tracker's filter in plain NumPy, as a textbook has it.

It is the yardstick: the benchmark times the compiled filter beside it, and a
test demands that both come to the same state.  When the foot stands, and how far
that can be trusted, is given; detection, floor, smoothing and what turns the walk as a whole are
not part of it.
"""

from __future__ import annotations

import numpy as np

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    LEVER,
    POSITION,
    SIZE,
    VELOCITY,
)
from edge.tracker.foot.filter.error_model import transition_matrix


class PlainFilter:
    """The state of ``error_model`` with its covariance (22, 22); temperature is left out."""

    def __init__(self, rotation_nb: Floats, covariance: Floats, config: EskfConfig) -> None:
        self.config = config
        self.position_n_m = np.zeros(3)
        self.velocity_n_mps = np.zeros(3)
        self.rotation_nb = rotation_nb.copy()
        self.gyro_bias_radps = np.zeros(3)
        self.accel_bias_mps2 = np.zeros(3)
        self.lever_b_m = np.zeros(3)
        self.covariance = covariance.copy()
        self._gravity_n_mps2 = np.array([0.0, 0.0, config.gravity_mps2])
        density = np.zeros(SIZE)
        density[VELOCITY : VELOCITY + 3] = config.process.accel_noise_mps2_rthz**2
        density[ATTITUDE : ATTITUDE + 3] = config.process.gyro_noise_radps_rthz**2
        density[GYRO_BIAS : GYRO_BIAS + 3] = config.process.gyro_bias_walk_radps2_rthz**2
        density[ACCEL_BIAS : ACCEL_BIAS + 3] = config.process.accel_bias_walk_mps3_rthz**2
        self._noise_density = np.diag(density)

    def predict(
        self,
        accel_mps2: Floats,
        gyro_radps: Floats,
        dt_s: float,
        bend_vars: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Move over one interval by its mean readings (3,), sensor axes.

        ``bend_vars`` are those of accelerometer and gyroscope (see intervals).
        """
        half = turn(0.5 * dt_s * (gyro_radps - self.gyro_bias_radps))
        self.rotation_nb = self.rotation_nb @ half
        force_n_mps2 = self.rotation_nb @ (accel_mps2 - self.accel_bias_mps2)
        self.rotation_nb = self.rotation_nb @ half
        step_mps = dt_s * (force_n_mps2 + self._gravity_n_mps2)
        self.position_n_m += dt_s * (self.velocity_n_mps + 0.5 * step_mps)
        self.velocity_n_mps += step_mps
        transition = transition_matrix(self.rotation_nb, force_n_mps2, dt_s)
        self.covariance = transition @ self.covariance @ transition.T
        self.covariance += dt_s * self._noise_density
        for first, bend_var in zip((VELOCITY, ATTITUDE), bend_vars, strict=True):
            bend = self.covariance[first : first + 3, first : first + 3]
            bend += dt_s**2 * bend_var * np.eye(3)

    def apply_zupt(
        self, gyro_radps: Floats, velocity_variance: float, rate_variance: float
    ) -> None:
        """Use the pseudo-measurements of a stance sample, all six at once."""
        rate_radps = gyro_radps - self.gyro_bias_radps
        lever_velocity = self.rotation_nb @ skew(rate_radps)
        measures = np.zeros((6, SIZE))
        measures[0:3, VELOCITY : VELOCITY + 3] = np.eye(3)
        measures[0:3, LEVER : LEVER + 3] = -lever_velocity
        measures[3:6, GYRO_BIAS : GYRO_BIAS + 3] = np.eye(3)
        noise = np.diag([velocity_variance] * 3 + [rate_variance] * 3)
        residual = np.concatenate(
            (lever_velocity @ self.lever_b_m - self.velocity_n_mps, rate_radps)
        )
        spread = measures @ self.covariance @ measures.T + noise
        gain = np.linalg.solve(spread, measures @ self.covariance).T
        self._correct(gain @ residual)
        kept = np.eye(SIZE) - gain @ measures
        self.covariance = kept @ self.covariance @ kept.T + gain @ noise @ gain.T

    def _correct(self, error: Floats) -> None:
        self.position_n_m += error[POSITION : POSITION + 3]
        self.velocity_n_mps += error[VELOCITY : VELOCITY + 3]
        self.rotation_nb = turn(error[ATTITUDE : ATTITUDE + 3]) @ self.rotation_nb
        self.gyro_bias_radps += error[GYRO_BIAS : GYRO_BIAS + 3]
        self.accel_bias_mps2 += error[ACCEL_BIAS : ACCEL_BIAS + 3]
        self.lever_b_m += error[LEVER : LEVER + 3]


def skew(vector: Floats) -> Floats:
    """Return the matrix (3, 3) of the cross product with ``vector``."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def turn(angle_rad: Floats) -> Floats:
    """Return the rotation matrix of a rotation vector (Rodrigues)."""
    angle = float(np.linalg.norm(angle_rad))
    cross = skew(angle_rad)
    if angle < 1e-8:
        return np.asarray(np.eye(3) + cross)
    a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2
    return np.asarray(np.eye(3) + a * cross + b * cross @ cross)
