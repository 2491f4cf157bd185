"""Stillness of a foot: SHOE's statistic of whole walks, in numpy, apart from the tracker's own."""

from __future__ import annotations

import numpy as np

from edge.samples import Floats, ImuBatch
from edge.simulation.imu import GRAVITY_MPS2

_HALF_WINDOW_S = 0.03
_RATE_WEIGHT_M2PS2 = 40.0


def stillness_m2ps4(imu: ImuBatch, rate_hz: float) -> Floats:
    """Return variance of the force, weighted square of the rate, and the norm off gravity (n,)."""
    count = 2 * round(_HALF_WINDOW_S * rate_hz) + 1

    def mean(values: Floats) -> Floats:
        edges = np.pad(values, ((count // 2, count // 2), (0, 0)), mode="edge")
        sums = np.cumsum(np.vstack((np.zeros((1, values.shape[1])), edges)), axis=0)
        means: Floats = (sums[count:] - sums[:-count]) / count
        return means

    force_mps2 = mean(imu.accel_mps2)
    variance = np.sum(mean(imu.accel_mps2**2) - force_mps2**2, axis=1)
    turning = _RATE_WEIGHT_M2PS2 * np.sum(mean(imu.gyro_radps**2), axis=1)
    off_mps2 = np.linalg.norm(force_mps2, axis=1) - GRAVITY_MPS2
    stillness: Floats = variance + turning + off_mps2**2
    return stillness


def stillest_of_strides_m2ps4(imu: ImuBatch, rate_hz: float) -> Floats:
    """Return the least statistic around each moment at which it is least for 0.3 s, moving."""
    stillness = stillness_m2ps4(imu, rate_hz)
    reach, about = round(0.3 * rate_hz), round(0.55 * rate_hz)
    turning_radps = np.linalg.norm(imu.gyro_radps, axis=1)
    found = [
        stillness[k]
        for k in range(2 * reach, len(stillness) - 2 * reach)
        if stillness[k] == stillness[k - reach : k + reach + 1].min()
        and turning_radps[max(k - about, 0) : k + about + 1].mean() > 2.0
    ]
    return np.array(found)


def clipped(values: Floats, full_scale: float) -> float:
    """Return the share of the samples (n, 3) of which an axis is at its full scale."""
    return float(np.mean(np.abs(values).max(axis=1) >= 0.995 * full_scale))
