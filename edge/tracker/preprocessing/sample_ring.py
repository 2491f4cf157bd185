"""Ring of recent samples, with what each stage finds of them and the row that is released.

Sample ``k`` (counted from 0) lies in slot ``k & mask``.  The ring is fixed in size, so a day of
samples takes no more memory than a second.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

SPAN_S = 1.0  # a row is final by then, so no stage waits or looks for longer
SPANS = 8  # that a ring holds: some strides
MIN_RING_HZ = 200.0  # room for a description that understates the rate
Ring: TypeAlias = NDArray[Any]  # (slots,) of RING; slots is a power of two
RING = np.dtype(
    [
        ("t_ns", np.int64),  # as recorded
        ("arrival_s", np.float64),  # the same since the first sample, never backward
        ("period_s", np.float64),  # from one sample taken to the next, as known so far
        ("t_s", np.float64),  # regular
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("mag_ut", np.float64, 3),  # NaN where there is none
        ("rate_saturated", np.uint8, 3),  # 1 where the rate of an axis is saturated
        ("force_saturated", np.uint8, 3),  # the same of the force, until it is recovered
        ("bridge_radps", np.float64, 3),  # bridged part of the rate, before it is scaled
        ("hidden_noise", np.float64, 3),  # rad^2/s about each axis after saturation
        ("hidden_force_noise", np.float64, 3),  # m^2/s^3 along each axis, likewise
        ("pressure_pa", np.float64),
        ("temperature_degc", np.float64),  # inside the sensor
        ("flags", np.int64),  # Reason bits of the sample itself
        ("motion_m2ps4", np.float64),  # stillness statistic
        ("stride_minimum_m2ps4", np.float64),  # its smallest value in the stride around
        ("position_n_m", np.float64, 3),
        ("position_cov_m2", np.float64, (3, 3)),
        ("velocity_n_mps", np.float64, 3),
        ("quaternion_nb", np.float64, 4),
        ("heading_std_rad", np.float64),
        ("magnetic_north_rad", np.float64),  # in the frame
        ("magnetic_north_std_rad", np.float64),
        ("distance_m", np.float64),
        ("steps", np.int64),
        ("past_shift_n_m", np.float64, 2),  # see correction_tracking
        ("past_turn_rad", np.float64),
        ("stationary", np.bool_),
        ("quality", np.uint8),
        ("reasons", np.uint32),
        ("rest_norm_mps2", np.float64),  # what was known of it when this was measured
        # Of this and all samples before; see stance_detection.
        ("force_sum_mps2", np.float64, 3),
        ("force_square_sum_m2ps4", np.float64),
        ("rate_sum_radps", np.float64, 3),
        ("rate_square_sum_rad2ps2", np.float64),
        ("motion_sum_m2ps4", np.float64),
        ("unrest_m2ps4", np.float64),  # the same over a longer time, whatever the bias
        ("interval_s", np.float64),  # since the sample before; negative after a long gap
    ],
    align=True,
)


def new_ring(rate_hz: float, span_s: float = SPAN_S) -> Ring:
    """Return an empty ring whose ``span`` lasts at least ``span_s`` at the described rate.

    The one place where seconds become slots: what ``span`` and ``history`` return follows from it.
    """
    slots = SPANS * span_s * max(rate_hz, MIN_RING_HZ)
    return np.zeros(1 << int(np.ceil(np.log2(slots))), RING)


@njit()
def reach(ring: Ring, k: int) -> int:
    """Return one past the last sample that work on sample ``k`` may look at."""
    return k + span(ring)


@njit()
def span(ring: Ring) -> int:
    """Return how many samples any stage waits for, or looks ahead or back over.

    Time bounds most looks, but a ring made for a much lower rate than the samples have cannot hold
    the whole look-ahead; the bound is the same however the samples come.
    """
    return len(ring) // SPANS


@njit()
def history(ring: Ring) -> int:
    """Return how many samples before one that is worked on are still in the ring.

    A batch may have been taken in behind what the last stage waits for.
    """
    return len(ring) - 2 * span(ring) - 1
