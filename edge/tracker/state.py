"""What the default tracker remembers: a ring of recent samples and the filter's state.

Everything is fixed in size, so a day of samples takes no more memory than a
second.  Sample ``k`` (counted from 0) lives in slot ``k & mask`` of the ring.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats
from edge.tracker.error_model import SIZE
from edge.tracker.kernel_cache import SOURCES

MAX_UPDATES = 8  # scalar updates one sample can bring

PROGRESS = np.dtype(
    [
        ("received", np.int64),  # samples in the ring so far
        ("timed", np.int64),  # ... with their regular time
        ("measured", np.int64),  # ... with their motion statistic
        ("filtered", np.int64),  # ... passed through the filter
        ("released", np.int64),  # ... final
        ("minimum_at", np.int64),  # sample with the smallest statistic of the stride
        ("minimum_from", np.int64),  # first sample of the stride around
        ("minimum_to", np.int64),  # one past its last
        ("steps", np.int64),
        ("gyro_clip_radps", np.float64),  # from the description
        ("in_stance", np.bool_),
        ("aligned", np.bool_),
        ("stance_since_s", np.float64),
        ("last_stance_s", np.float64),
        ("gyro_saturated_s", np.float64),  # when last seen
        ("accel_saturated_s", np.float64),
        ("gap_s", np.float64),
        ("foothold_north_m", np.float64),
        ("foothold_east_m", np.float64),
        ("distance_m", np.float64),
        ("on_floor", np.bool_),  # the fields below are known
        ("level_m", np.float64),  # height (down) of the floor walked on
        ("level_variance_m2", np.float64),
        ("footfall_m", np.float64),  # height of the last footfall
        ("footfall_s", np.float64),
        ("mean_sink_m", np.float64),  # of the last strides, before the floor's correction
        ("withheld_m", np.float64),  # what the floor has taken out in one direction
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ]
)


class Ring(NamedTuple):
    """Recent samples and all that is known of each; ``n`` slots, a power of two."""

    t_ns: NDArray[np.int64]  # (n,) as recorded
    arrival_s: Floats  # (n,) as recorded, since the first sample, without backward steps
    period_s: Floats  # (n,) mean time between samples up to this one
    t_s: Floats  # (n,) regular
    accel_mps2: Floats  # (n, 3)
    gyro_radps: Floats  # (n, 3)
    hidden_noise: Floats  # (n, 3) rad^2/s that clipping leaves in doubt about each sensor axis
    flags: NDArray[np.uint32]  # (n,) Reason bits of the sample itself
    motion_m2ps4: Floats  # (n,) stillness statistic
    stride_minimum_m2ps4: Floats  # (n,) its smallest value in the stride around
    position_n_m: Floats  # (n, 3)
    velocity_n_mps: Floats  # (n, 3)
    quaternion_nb: Floats  # (n, 4)
    covariance: Floats  # (n, 9, 18) its rows of position, velocity and attitude
    interval_s: Floats  # (n,) since the sample before; negative after a gap
    force_n_mps2: Floats  # (n, 3) over that interval
    rotation_nb: Floats  # (n, 3, 3) at its end
    lever_row: Floats  # (n, 3, 3) how the lever enters the velocity updates
    updates: NDArray[np.int64]  # (n,) how many scalar updates followed
    update_index: NDArray[np.int64]  # (n, MAX_UPDATES) which error was measured
    update_gain: Floats  # (n, MAX_UPDATES, 18)
    update_pull: Floats  # (n, MAX_UPDATES) innovation by its variance
    stationary: NDArray[np.bool_]  # (n,)
    heading_std_rad: Floats  # (n,)
    distance_m: Floats  # (n,)
    steps: NDArray[np.int64]  # (n,)
    quality: NDArray[np.uint8]  # (n,)
    reasons: NDArray[np.uint32]  # (n,)


class FilterState(NamedTuple):
    """The filter after the last sample it has taken, and room to work in."""

    position_n_m: Floats  # (3,)
    velocity_n_mps: Floats  # (3,)
    quaternion_nb: Floats  # (4,)
    rotation_nb: Floats  # (3, 3)
    gyro_bias_radps: Floats  # (3,)
    accel_bias_mps2: Floats  # (3,)
    lever_b_m: Floats  # (3,) from the point the foot rolls about to the sensor
    covariance: Floats  # (18, 18), see error_model
    error: Floats  # (18,) scratch: correction gathered at one instant
    column: Floats  # (18,) scratch
    force_n_mps2: Floats  # (3,) scratch
    accel_mps2: Floats  # (3,) scratch
    gyro_radps: Floats  # (3,) scratch
    angle_rad: Floats  # (3,) scratch


@njit()
def reach(ring: Ring, k: int) -> int:
    """Return one past the last sample that work on sample ``k`` may look at.

    A ring made for a much lower rate than the samples have cannot hold the whole
    look-ahead; the bound is the same however the samples come.
    """
    return k + len(ring.t_ns) // 4


def new_ring(slots: int) -> Ring:
    """Return an empty ring of ``slots`` (a power of two) samples."""
    return Ring(
        t_ns=np.zeros(slots, np.int64),
        arrival_s=np.zeros(slots),
        period_s=np.zeros(slots),
        t_s=np.zeros(slots),
        accel_mps2=np.zeros((slots, 3)),
        gyro_radps=np.zeros((slots, 3)),
        hidden_noise=np.zeros((slots, 3)),
        flags=np.zeros(slots, np.uint32),
        motion_m2ps4=np.zeros(slots),
        stride_minimum_m2ps4=np.zeros(slots),
        position_n_m=np.zeros((slots, 3)),
        velocity_n_mps=np.zeros((slots, 3)),
        quaternion_nb=np.zeros((slots, 4)),
        covariance=np.zeros((slots, 9, SIZE)),
        interval_s=np.zeros(slots),
        force_n_mps2=np.zeros((slots, 3)),
        rotation_nb=np.zeros((slots, 3, 3)),
        lever_row=np.zeros((slots, 3, 3)),
        updates=np.zeros(slots, np.int64),
        update_index=np.zeros((slots, MAX_UPDATES), np.int64),
        update_gain=np.zeros((slots, MAX_UPDATES, SIZE)),
        update_pull=np.zeros((slots, MAX_UPDATES)),
        stationary=np.zeros(slots, np.bool_),
        heading_std_rad=np.zeros(slots),
        distance_m=np.zeros(slots),
        steps=np.zeros(slots, np.int64),
        quality=np.zeros(slots, np.uint8),
        reasons=np.zeros(slots, np.uint32),
    )


def new_filter_state() -> FilterState:
    return FilterState(
        position_n_m=np.zeros(3),
        velocity_n_mps=np.zeros(3),
        quaternion_nb=np.array([1.0, 0.0, 0.0, 0.0]),
        rotation_nb=np.eye(3),
        gyro_bias_radps=np.zeros(3),
        accel_bias_mps2=np.zeros(3),
        lever_b_m=np.zeros(3),
        covariance=np.zeros((SIZE, SIZE)),
        error=np.zeros(SIZE),
        column=np.zeros(SIZE),
        force_n_mps2=np.zeros(3),
        accel_mps2=np.zeros(3),
        gyro_radps=np.zeros(3),
        angle_rad=np.zeros(3),
    )


def new_progress() -> NDArray[Any]:
    """Return the one-row record array of counters and times (``PROGRESS``)."""
    progress = np.zeros(1, PROGRESS)
    for name in ("stance_since_s", "gyro_saturated_s", "accel_saturated_s", "gap_s"):
        progress[name] = -1e9
    return progress
