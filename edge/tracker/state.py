"""What the default tracker remembers: a ring of recent samples, the way back, and the state.

Everything is fixed in size, so a day of samples takes no more memory than a
second.  Sample ``k`` (counted from 0) lives in slot ``k & mask`` of the ring; what the smoother
needs of it, which is most of the memory and is wanted for the lag only, in a slot of the shorter
``trail``.  All are record arrays, because the compiled kernels hand a record on as one
pointer, and because what belongs to a sample then lies together.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.tracker.error_model import SIZE
from edge.tracker.kernel_cache import SOURCES

MAX_UPDATES = 10  # scalar updates one sample can bring
COMPASS_SIZE = 13  # states of magnetic_field
GAIN_ERRORS = 18  # see gain_errors
BELIEFS = 5
LIKE_STRIDES = 3  # of which the mean is taken

Ring: TypeAlias = NDArray[Any]  # (slots,) of RING; slots is a power of two
Trail: TypeAlias = NDArray[Any]  # (slots,) of STEP, for an eighth of the ring's samples
Step: TypeAlias = Any  # one record of STEP
Progress: TypeAlias = Any  # one record of PROGRESS
FilterState: TypeAlias = Any  # one record of FILTER
Aid: TypeAlias = Any  # one record of COMPASS, BELIEF or BAROMETER

RING = np.dtype(
    [
        ("t_ns", np.int64),  # as recorded
        ("arrival_s", np.float64),  # the same since the first sample, never backward
        ("period_s", np.float64),  # from one sample taken to the next, as known so far
        ("t_s", np.float64),  # regular
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("mag_ut", np.float64, 3),  # NaN where there is none
        ("clipped", np.uint8, 3),  # 1 where the rate of an axis has
        ("force_clipped", np.uint8, 3),  # the same of the force, until it is bridged
        ("hidden_noise", np.float64, 3),  # rad^2/s in doubt about each axis after clipping
        ("hidden_force_noise", np.float64, 3),  # m^2/s^3 in doubt along each axis, likewise
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
        ("past_shift_n_m", np.float64, 2),  # see past
        ("past_turn_rad", np.float64),
        ("stationary", np.bool_),
        ("quality", np.uint8),
        ("reasons", np.uint32),
        ("rest_norm_mps2", np.float64),  # what was known of it when this was measured
        ("motion_sum_m2ps4", np.float64),  # of this and all samples before
        ("rate_sum_radps", np.float64, 3),  # the same
        ("rate_square_sum_rad2ps2", np.float64),  # the same
        ("unrest_m2ps4", np.float64),  # the same over a longer time, whatever the bias
        ("interval_s", np.float64),  # since the sample before; negative after a long gap
    ],
    align=True,
)

# What the smoother needs to go back over a sample.
STEP = np.dtype(
    [
        ("force_n_mps2", np.float64, 3),  # over the interval since the sample before
        ("warmed_k", np.float64),  # step of the temperature that the biases took
        ("rotation_nb", np.float64, (3, 3)),  # at its end
        ("lever_row", np.float64, (3, 3)),  # how the lever enters the velocity updates
        ("updates", np.int64),  # scalar updates that followed
        ("update_index", np.int64, MAX_UPDATES),  # which error was measured
        ("update_pull", np.float64, MAX_UPDATES),  # innovation by its variance
        ("update_gain", np.float64, (MAX_UPDATES, SIZE)),
        ("covariance", np.float64, (10, SIZE)),  # rows of navigation
    ],
    align=True,
)

# A side filter (side_filter.py): one belief of how steel bends the field (magnetic_field.py).
BELIEF = np.dtype(
    [
        ("estimate", np.float64, COMPASS_SIZE),
        ("covariance", np.float64, (COMPASS_SIZE, COMPASS_SIZE)),
        ("log_weight", np.float64),  # beside the likeliest
        ("weight", np.float64),
        ("north_weight", np.float64),  # by strength and dip as well
        ("wide_var_ut2", np.float64),  # of what steel does to the field in a part of a building
        ("bend_var_ut2", np.float64),  # and just around here
        # Scratch.
        ("near_is_new", np.float64),
        ("wide_is_new", np.float64),
        ("strength_ut", np.float64),
        ("aim_n", np.float64, 2),
    ],
    align=True,
)

# The beliefs, and what the magnetometer has shown since they were last looked at.
COMPASS = np.dtype(
    [
        ("beliefs", BELIEF, BELIEFS),
        ("started", np.bool_),
        ("calibrated", np.bool_),
        ("iron_std_ut", np.float64),  # of iron on the foot, before it is seen
        ("north_rad", np.float64),  # of magnetic north in the frame, at the last look
        ("north_var_rad2", np.float64),
        ("heading_var_rad2", np.float64),  # the main filter's then
        ("earth_known", np.bool_),  # the field by the model, from a sample's time on
        ("earth_from_ns", np.int64),
        ("earth_horizontal_ut", np.float64),
        ("earth_down_ut", np.float64),
        ("north_m", np.float64),  # where the last look was
        ("east_m", np.float64),
        ("samples", np.int64),  # in this stance so far
        ("since_s", np.float64),
        ("field_n_ut", np.float64, 3),  # their mean
        ("rotation_nb", np.float64, (3, 3)),  # and that of their attitudes
        # Scratch.
        ("row", np.float64, COMPASS_SIZE),
        ("column", np.float64, COMPASS_SIZE),
    ],
    align=True,
)

# A side filter and what the barometer has shown since it was last looked at.
BAROMETER = np.dtype(
    [
        ("estimate", np.float64, 2),
        ("covariance", np.float64, (2, 2)),
        ("started", np.bool_),
        ("reference_pa", np.float64),
        ("looked_s", np.float64),
        ("noise_var_m2", np.float64),  # of a look
        ("refused", np.int64),  # looks in a row
        ("samples", np.int64),  # in this stance so far
        ("since_s", np.float64),
        ("off_m", np.float64),  # their mean below the tracker's height
        ("force_mps2", np.float64),  # and mean norm of the accelerometer
        ("rest_mps2", np.float64),  # what that is of somebody who stands
        ("riding", np.bool_),  # perhaps in a lift
        ("felt_s", np.float64),  # when it last pushed or rose
        ("said_pa", np.float64),  # last
        ("changed_s", np.float64),
        ("steps", np.int64),  # when that was last looked at
        ("watched", np.int64),  # ... and the floor
        ("mean_off_m", np.float64),  # of the last strides
        # Scratch.
        ("row", np.float64, 2),
        ("column", np.float64, 2),
    ],
    align=True,
)

GAINS = np.dtype(
    [
        ("std", np.float64),  # of scale and axes
        ("turned_rad", np.float64, GAIN_ERRORS),  # heading by each error so far
        ("turned_column", np.float64, GAIN_ERRORS),  # the covariance times that
        ("carried_m", np.float64, (2, GAIN_ERRORS)),  # position north and east
        ("estimate", np.float64, GAIN_ERRORS),
        ("covariance", np.float64, (GAIN_ERRORS, GAIN_ERRORS)),
        ("heard", np.bool_),  # a compass
        ("down_b", np.float64, 3),  # at the last sample
        # Scratch.
        ("column", np.float64, GAIN_ERRORS),
    ],
    align=True,
)

PAST = np.dtype(
    [
        ("shift_n_m", np.float64, 2),  # by which the position was put right since the start
        ("turn_rad", np.float64),  # ... and the heading, but for what the walk has taken over
        ("stance_turn_rad", np.float64),  # of that, in this stance
        ("covariance", np.float64, (3, SIZE)),  # of its position and heading with the error state
        # Scratch.
        ("error", np.float64, 3),  # correction gathered at one instant
    ],
    align=True,
)

FILTER = np.dtype(
    [
        ("position_n_m", np.float64, 3),
        ("velocity_n_mps", np.float64, 3),
        ("quaternion_nb", np.float64, 4),
        ("rotation_nb", np.float64, (3, 3)),
        ("gyro_bias_radps", np.float64, 3),
        ("accel_bias_mps2", np.float64, 3),
        ("lever_b_m", np.float64, 3),  # from the point the foot rolls about to the sensor
        ("rest_force_mps2", np.float64, 3),  # sensor axes, where the gyroscope bias was learned
        ("gyro_bias_per_k", np.float64, 3),
        ("gains", GAINS),  # see gain_errors
        ("bent_n_m", np.float64, 2),  # see stated
        # The gyroscope's bias before a rest; see first_rest.
        ("bias_shown", np.bool_),
        ("unshown_bias_std_radps", np.float64),
        ("unshown", np.float64, 3),  # north and east (m) and heading (rad) by one deviation of it
        ("doubted_b", np.float64, 3),  # unit vector along which it is known least
        ("rest_rate_radps", np.float64, 3),  # mean rate around the last still sample
        ("rest_rate_var_rad2ps2", np.float64),  # the rate's scatter about it
        ("past", PAST),  # see past
        ("ramp_var_m2", np.float64),  # doubt whether the floor is flat; see floor
        # How an ordinary stride's noise is stated; see landing.
        ("swing_rad", np.float64),  # that the foot has turned since it stood
        ("landing_off", np.float64),  # mean velocity that a landing is off, m/s for each radian
        ("strike_off", np.float64),  # ... of the vertical velocity: what heel strikes have left
        ("strikes", np.float64),  # from which that is known
        ("faultless_var_m2ps2", np.float64),  # of a velocity since it stood, but for faults
        ("landings", np.float64),  # from which landing_off is known
        ("swing_speed_mps", np.float64),  # the foot's highest since it stood
        ("gain_off", np.float64),  # mean of landings that tell of the gains, at an ordinary speed
        ("faulty_stride", np.bool_),  # since the last lift-off
        ("noise_m2", np.float64),  # of both horizontal axes at the last lift-off
        ("ordinary_m2", np.float64),  # ... by strides without a fault
        ("noise_rad2", np.float64),  # of the heading at the last lift-off
        ("ordinary_rad2", np.float64),  # ... by strides without a fault
        ("covariance", np.float64, (SIZE, SIZE)),  # see error_model
        ("compass", COMPASS),  # see magnetic_heading
        ("barometer", BAROMETER),  # see barometric_height
        # Scratch.
        ("error", np.float64, SIZE),  # correction gathered at one instant
        ("column", np.float64, SIZE),
        ("force_n_mps2", np.float64, 3),
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("angle_rad", np.float64, 3),
        ("gyro_bend_var", np.float64),  # see intervals
        ("force_unseen_var", np.float64),
        (
            "hole_means",
            np.float64,
            (3, 3),
        ),  # rate, force, and that in navigation axes; see bridging
    ],
    align=True,
)

PROGRESS = np.dtype(
    [
        ("received", np.int64),  # samples in the ring so far
        ("cleaned", np.int64),  # ... looked at for spikes
        ("timed", np.int64),  # ... with their regular time
        ("measured", np.int64),  # ... with their motion statistic
        ("filtered", np.int64),  # ... passed through the filter
        ("released", np.int64),  # ... final
        ("minimum_at", np.int64),  # sample with the smallest statistic of the stride
        ("minimum_from", np.int64),  # first sample of the stride around
        ("minimum_to", np.int64),  # one past its last
        ("steps", np.int64),
        ("rest_norm_mps2", np.float64),  # what the accelerometer shows at rest
        ("temperature_degc", np.float64),  # smoothed; NaN while unknown
        ("temperature_s", np.float64),  # of the sample that said it
        ("warmed_degc", np.float64),  # for which the gyroscope bias holds
        ("good_ns", np.int64),  # stamp of the last sample that was not bad
        ("began_at", np.int64),  # sample before which nothing is known of the motion
        ("began_s", np.float64),  # ... and its time
        # Strides like the hole before the sample that is filtered next; see like_strides.
        ("like_count", np.int64),
        ("like_at", np.int64, LIKE_STRIDES),  # the sample after which it went on
        ("like_off_m2ps4", np.float64, LIKE_STRIDES),  # how unlike the samples around are
        ("like_weight", np.float64, LIKE_STRIDES),
        ("in_stance", np.bool_),
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
        ("footfall_n_m", np.float64, 3),  # of the last footfall
        ("footfall_s", np.float64),
        ("footfall_variance_m2", np.float64),  # of its height
        ("mean_sink_m", np.float64),  # of the last strides, before the floor's correction
        ("floor_doubted", np.bool_),  # by the barometer
        ("habit_m", np.float64),  # by which a stride on the flat seems to sink
        ("flat_strides", np.float64),  # from which that is known
        ("climbed", np.float64),  # strides that left a level
        ("withheld_m", np.float64),  # what the floor has taken out in one direction
        ("past_ramps_m2", np.float64),  # doubt whether what it took out before was a ramp
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)


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
    return len(ring) // 8


@njit()
def history(ring: Ring) -> int:
    """Return how many samples before one that is worked on are still in the ring.

    A batch may have been taken in behind what the last stage waits for.
    """
    return len(ring) - 2 * span(ring) - 1


def new_filter_state() -> NDArray[Any]:
    """Return one record of ``FILTER``."""
    state = np.zeros(1, FILTER)
    state["quaternion_nb"][0] = [1.0, 0.0, 0.0, 0.0]
    state["rotation_nb"][0] = np.eye(3)
    state["gains"]["covariance"][0] = np.eye(GAIN_ERRORS)
    state["faulty_stride"] = True
    state["compass"]["north_var_rad2"] = np.inf
    return state


def new_progress() -> NDArray[Any]:
    """Return one record of ``PROGRESS``."""
    progress = np.zeros(1, PROGRESS)
    for name in ("stance_since_s", "gyro_saturated_s", "accel_saturated_s", "gap_s"):
        progress[name] = -1e9
    progress["temperature_degc"] = np.nan
    return progress
