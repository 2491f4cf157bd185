"""A foot that is raised and slowly put down on the spot, exact like ``tests.rig.exact_strides``.

It goes down evenly and without turning, so its stillest moment of a stride is in mid-air.
"""

from __future__ import annotations

import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription
from tests.rig.exact_strides import EASE, GRAVITY_MPS2

RATE_HZ = 200.0
STARTS_S, RAISES_S, LOWERS_S, RESTS_S = 4.0, 0.6, 1.0, 0.6
TILT_RAD = -0.5  # toes down while it is raised
_SPEEDS_UP = np.poly1d([-0.5, 1.0, 0.0, 0.0, 0.0])  # way by u while the speed goes from 0 to 1
_EASES_S = 0.2


def raised_slowly(times: int, height_m: float = 0.6, seed: int = 1) -> ImuBatch:
    """Stand for ``STARTS_S``, then raise the foot and put it down ``times`` times."""
    period_s = RAISES_S + LOWERS_S + RESTS_S
    t_s = np.arange(0.0, STARTS_S + times * period_s + 1.0, 1.0 / RATE_HZ)
    since_s = np.clip(t_s - STARTS_S, 0.0, None)
    since_s = since_s - np.minimum(np.floor(since_s / period_s), times - 1) * period_s
    u = np.clip(since_s / RAISES_S, 0.0, 1.0)
    up_mps2 = height_m * EASE.deriv(2)(u) / RAISES_S**2
    up_mps2 = np.where((u > 0.0) & (u < 1.0), up_mps2, 0.0)
    up_mps2 += _lowering_mps2(since_s - RAISES_S, height_m)
    # It turns while it is raised, and back on the last part of the way down.
    back = np.clip((since_s - RAISES_S - LOWERS_S + _EASES_S) / _EASES_S, 0.0, 1.0)
    pitch_rad = TILT_RAD * (EASE(u) - EASE(back))
    pitch_radps = TILT_RAD * (EASE.deriv()(u) / RAISES_S - EASE.deriv()(back) / _EASES_S)
    down_mps2 = -up_mps2 - GRAVITY_MPS2
    zero = np.zeros_like(t_s)
    accel = np.column_stack((-np.sin(pitch_rad) * down_mps2, zero, np.cos(pitch_rad) * down_mps2))
    gyro = np.column_stack((zero, pitch_radps, zero))
    noise = np.random.default_rng(seed)
    accel += 0.02 * noise.standard_normal(accel.shape)
    gyro += 0.002 * noise.standard_normal(gyro.shape)
    return ImuBatch(np.rint(t_s * 1e9).astype(np.int64), accel, gyro)


def _lowering_mps2(since_s: Floats, height_m: float) -> Floats:
    """Return the acceleration (n,) up of a way down at an even speed but for both its ends."""
    speed_mps = height_m / (LOWERS_S - _EASES_S)
    begins, ends = since_s / _EASES_S, (LOWERS_S - since_s) / _EASES_S
    push = _SPEEDS_UP.deriv(2)
    begun = np.where((begins > 0.0) & (begins < 1.0), push(begins), 0.0)
    ended = np.where((ends > 0.0) & (ends < 1.0), push(ends), 0.0)
    return (ended - begun) * speed_mps / _EASES_S


DESCRIPTION = SensorDescription("synthetic", RATE_HZ)
