"""A foot that walks straight strides, exact to the last bit of calculus: for tracker tests.

Position and pitch are polynomials of time, so specific force and rate follow
in closed form.  It is a test's measuring stick, not the simulator of people.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription

GRAVITY_MPS2 = 9.80665
BUMP = np.poly1d([-64, 192, -192, 64, 0, 0, 0])  # 64 u^3 (1-u)^3
EASE = np.poly1d([6, -15, 10, 0, 0, 0])  # 0 to 1, still at both ends
SWAY = BUMP * np.poly1d([-2, 1])  # pitch: toe up, then toe down


@dataclass(frozen=True)
class Walk:
    imu: ImuBatch
    position_n_m: Floats  # (n, 3)
    standing: np.ndarray  # (n,)
    description: SensorDescription


def walk(
    strides: int = 12,
    rate_hz: float = 200.0,
    stride_m: float = 1.3,
    rise_m: float = 0.0,
    start_s: float = 2.0,
    gyro_noise_radps: float = 0.002,
    accel_noise_mps2: float = 0.02,
    gyro_bias_radps: tuple[float, float, float] = (0.0, 0.0, 0.0),
    accel_bias_mps2: tuple[float, float, float] = (0.0, 0.0, 0.0),
    seed: int = 1,
) -> Walk:
    """Walk north: still for ``start_s``, then strides of 0.7 s swing and 0.5 s stance."""
    swing_s, stance_s = 0.7, 0.5
    duration_s = start_s + strides * (swing_s + stance_s) + 1.0
    t_s = np.arange(0.0, duration_s, 1.0 / rate_hz)
    since_s = t_s - start_s
    stride = np.clip(np.floor(since_s / (swing_s + stance_s)), 0, strides - 1)
    u = np.clip((since_s - stride * (swing_s + stance_s)) / swing_s, 0.0, 1.0)
    along_m = stride_m * (stride + EASE(u))
    up_m = 0.15 * BUMP(u) + rise_m * (stride + EASE(u))
    along_mps2 = stride_m * EASE.deriv(2)(u) / swing_s**2
    up_mps2 = (0.15 * BUMP.deriv(2)(u) + rise_m * EASE.deriv(2)(u)) / swing_s**2
    pitch_rad = 0.9 * SWAY(u)
    pitch_radps = 0.9 * SWAY.deriv()(u) / swing_s
    moving = (u > 0.0) & (u < 1.0)
    along_mps2, up_mps2, pitch_radps = (
        np.where(moving, value, 0.0) for value in (along_mps2, up_mps2, pitch_radps)
    )
    down_mps2 = -up_mps2 - GRAVITY_MPS2
    c, s = np.cos(pitch_rad), np.sin(pitch_rad)
    zero = np.zeros_like(t_s)
    accel = np.column_stack((c * along_mps2 - s * down_mps2, zero, s * along_mps2 + c * down_mps2))
    gyro = np.column_stack((zero, pitch_radps, zero))
    noise = np.random.default_rng(seed)
    accel += np.asarray(accel_bias_mps2) + accel_noise_mps2 * noise.standard_normal(accel.shape)
    gyro += np.asarray(gyro_bias_radps) + gyro_noise_radps * noise.standard_normal(gyro.shape)
    return Walk(
        imu=ImuBatch(np.rint(t_s * 1e9).astype(np.int64), accel, gyro),
        position_n_m=np.column_stack((along_m, zero, -up_m)),
        standing=~moving,
        description=SensorDescription("synthetic", rate_hz),
    )


def part(imu: ImuBatch, rows: slice) -> ImuBatch:
    return ImuBatch(imu.t_ns[rows], imu.accel_mps2[rows], imu.gyro_radps[rows])
