"""Memory of the default tracker: filter state, progress, and what the smoother needs of each
sample.

Everything is fixed in size.  What the smoother needs of sample ``k``, which is most of the memory
and is wanted for the lag only, lies in a slot of the short ``trail``.  All are record arrays,
because compiled kernels hand a record on as one pointer.  Comments give units in the names and the
module that owns a field.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from edge.tracker.foot.error_state import SIZE
from edge.tracker.kernel_cache import SOURCES

MAX_UPDATES = 10  # scalar updates one sample can bring
COMPASS_SIZE = 13  # states of magnetic_field
SCALE_ERRORS = 18  # see scale_misalignment
FIELD_HYPOTHESES = 5
SIMILAR_STRIDES = 3  # of which the mean is taken
CLONES = 3  # rows of the clone: north, east and heading of a moment ago; see correction_tracking
BRIDGES = 6  # scales: an axis of the gyroscope and a side each; see bridge_scale

Trail: TypeAlias = NDArray[Any]  # (slots,) of STEP, for an eighth of the ring's samples
Step: TypeAlias = Any  # one record of STEP
Bridge: TypeAlias = Any  # one record of BRIDGE
Progress: TypeAlias = Any  # one record of PROGRESS
Window: TypeAlias = Any  # one record of WINDOW
FilterState: TypeAlias = Any  # one record of FILTER
Aid: TypeAlias = Any  # one record of COMPASS, BELIEF or BAROMETER

# What the smoother needs to go back over a sample.
STEP = np.dtype(
    [
        ("force_n_mps2", np.float64, 3),  # over the interval since the sample before
        ("bias_step_k", np.float64),  # step of the temperature that the biases took
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

# A side filter (aiding_filter.py): one belief of how steel bends the field (magnetic_field.py).
FIELD_HYPOTHESIS = np.dtype(
    [
        ("estimate", np.float64, COMPASS_SIZE),
        ("covariance", np.float64, (COMPASS_SIZE, COMPASS_SIZE)),
        ("log_weight", np.float64),  # beside the likeliest
        ("weight", np.float64),
        ("north_weight", np.float64),  # by strength and dip as well
        ("wide_var_ut2", np.float64),  # of what steel does to the field in a part of a building
        ("distortion_var_ut2", np.float64),  # and just around here
        # Scratch.
        ("near_renewal", np.float64),
        ("wide_renewal", np.float64),
        ("strength_ut", np.float64),
        ("field_direction_n", np.float64, 2),
    ],
    align=True,
)

# The beliefs, and what the magnetometer has shown since they were last looked at.
COMPASS = np.dtype(
    [
        ("hypotheses", FIELD_HYPOTHESIS, FIELD_HYPOTHESES),
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
        ("updated_s", np.float64),
        ("noise_var_m2", np.float64),  # of a look
        ("rejected", np.int64),  # looks in a row
        ("samples", np.int64),  # in this stance so far
        ("since_s", np.float64),
        ("off_m", np.float64),  # their mean below the tracker's height
        ("force_mps2", np.float64),  # and mean norm of the accelerometer
        ("rest_mps2", np.float64),  # the same while a person stands
        ("riding", np.bool_),  # perhaps in a lift
        ("last_motion_s", np.float64),  # when it last pushed or rose
        ("last_pa", np.float64),  # last
        ("changed_s", np.float64),
        ("steps", np.int64),  # when that was last looked at
        ("checked_at_steps", np.int64),  # ... and the floor
        ("mean_off_m", np.float64),  # of the last strides
        # Scratch.
        ("row", np.float64, 2),
        ("column", np.float64, 2),
    ],
    align=True,
)

SCALE_ERROR_STATE = np.dtype(
    [
        ("std", np.float64),  # of scale and axes
        ("least_share", np.float64),  # of the variance by that, which is reported in any case
        ("heading_sensitivity", np.float64, SCALE_ERRORS),  # heading by each error so far
        ("heading_column", np.float64, SCALE_ERRORS),  # the covariance times that
        ("position_sensitivity", np.float64, (2, SCALE_ERRORS)),  # position north and east
        ("position_column", np.float64, (2, SCALE_ERRORS)),  # the covariance times those
        ("estimate", np.float64, SCALE_ERRORS),
        ("covariance", np.float64, (SCALE_ERRORS, SCALE_ERRORS)),
        ("compass_used", np.bool_),  # a compass
        ("down_b", np.float64, 3),  # at the last sample
    ],
    align=True,
)

CLONE = np.dtype(
    [
        ("shift_n_m", np.float64, 2),  # by which the position was put right since the start
        ("turn_rad", np.float64),  # ... and the heading, but for what the walk has taken over
        ("stance_turn_rad", np.float64),  # of that, in this stance
        ("rows", np.int64),  # in use: those of bridge_scale too once a rate has clipped
        # Of its position and heading, then of the scales of bridges, with the error state.
        ("covariance", np.float64, (CLONES + BRIDGES, SIZE)),
        # Scratch.
        ("error", np.float64, CLONES + BRIDGES),  # correction gathered at one instant
        ("column", np.float64, CLONES + BRIDGES),  # covariance with what is measured, or widened
    ],
    align=True,
)

# By which the bridged part of a rate is multiplied, by axis and side; see bridge_scale.
BRIDGE = np.dtype(
    [
        ("scale", np.float64, BRIDGES),
        ("covariance", np.float64, (BRIDGES, BRIDGES)),
    ],
    align=True,
)

# The hypothesis that the last stance was none; see stance_revision.
RIVAL = np.dtype(
    [
        ("alive", np.bool_),
        ("began_s", np.float64),  # that stance
        ("off_n_mps", np.float64, 3),  # velocity that its first sample has taken away
        ("variance_m2ps2", np.float64, 3),  # ... of that, had it been one
        ("error", np.float64, SIZE),  # by which it has corrected the state, carried on
        ("recent_evidence", np.float64),  # of the last decision against one, the older the less
        # What to restore if it was none: that of the filter before it, and what it has widened.
        ("recent_nis", np.float64),
        ("mean_zupt_residual", np.float64),
        ("mean_strike_residual", np.float64),
        ("mean_scale_residual", np.float64),
        ("mean_gain_residual", np.float64),
        ("gain_residual", np.float64),
        ("misfit_n_m", np.float64, 3),
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
        ("scale_errors", SCALE_ERROR_STATE),  # see scale_misalignment
        # What the heading's error does to the way beyond the first order; see reported_covariance.
        ("second_order_n_m", np.float64, 2),
        ("third_order_n_m", np.float64, 2),
        # What clipped rates hide in every swing alike; see hidden_turn.
        ("swing_hidden_rad2", np.float64),  # variance of the heading by this swing
        ("hidden_turn_rad", np.float64),  # by all so far
        ("hidden_way_n_m", np.float64, 2),  # by which that moves the position
        # What gaps hide of the turn; see gap_turn.
        ("gap_turn_rad2", np.float64),  # variance of the heading by all so far
        ("gap_turn_is_new", np.bool_),  # no stance has followed the last one
        ("gap_way_n_m", np.float64, 2),  # by which what is forgotten of it moves the position
        # The gyroscope's bias before a rest; see initial_gyro_bias.
        ("bias_observed", np.bool_),
        ("unobserved_bias_std_radps", np.float64),
        ("bias_information_s2prad2", np.float64),  # by rests and landings
        (
            "unobserved_effect",
            np.float64,
            3,
        ),  # north and east (m) and heading (rad) by one deviation of it
        ("least_known_axis_b", np.float64, 3),  # unit vector along which it is known least
        ("rest_rate_radps", np.float64, 3),  # mean rate around the last still sample
        ("rest_rate_var_rad2ps2", np.float64),  # the rate's scatter about it
        ("clone", CLONE),  # see correction_tracking
        ("bridge", BRIDGE),  # see bridge_scale
        ("ramp_var_m2", np.float64),  # in case the floor is a ramp; see level_walking
        ("hidden_rise_m", np.float64),  # that clipping may have hidden, alike in every stride
        # How an ordinary stride's noise is stated; see zupt_residuals.
        ("swing_rad", np.float64),  # that the foot has turned since it stood
        (
            "mean_zupt_residual",
            np.float64,
        ),  # mean velocity that a landing is off, m/s for each radian
        (
            "mean_strike_residual",
            np.float64,
        ),  # ... of the vertical velocity: what heel strikes have left
        ("strike_count", np.float64),  # from which that is known
        ("faultless_var_m2ps2", np.float64),  # of a velocity since it stood, but for faults
        ("zupt_residual_count", np.float64),  # from which landing_off is known
        ("swing_speed_mps", np.float64),  # the foot's highest since it stood
        ("swing_level_speed_mps", np.float64),  # ... of what is horizontal of it
        (
            "mean_scale_residual",
            np.float64,
        ),  # mean of landings that tell of the gains, at an ordinary speed
        ("mean_gain_residual", np.float64),  # the same as reported, bounded at that speed
        ("gain_landing_count", np.float64),  # that have shown the gains
        ("gain_residual", np.float64),  # the largest such mean
        ("faulty_stride", np.bool_),  # since the last lift-off
        # Whether stances and swings agree; see stance_consistency.
        ("stance_nis", np.float64),  # normalised innovation squared of this stance so far
        ("recent_nis", np.float64),  # ... of the stances before it, the older the less
        ("stance_misfits", np.bool_),
        ("stance_off_n_mps", np.float64, 3),  # velocity that its first sample takes away
        ("stance_after_s", np.float64),  # since the stance before
        ("stance_scale_error_mps", np.float64),  # by which the gains may have put that off
        ("misfit_n_m", np.float64, 3),  # distance that inconsistent stances have left uncertain
        ("rival", RIVAL),  # see stance_revision
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
        ("velocity_column", np.float64, (3, SIZE)),
        ("force_n_mps2", np.float64, 3),
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("angle_rad", np.float64, 3),
        ("gyro_curvature_var", np.float64),  # see integration
        ("force_curvature_var", np.float64),
        (
            "gap_means",
            np.float64,
            (3, 3),
        ),  # rate, force, and that in navigation axes; see gap_filling
    ],
    align=True,
)

# Samples around one, found from those around the sample before; see stance_detection.
WINDOW = np.dtype([("first", np.int64), ("last", np.int64)], align=True)

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
        ("motion_window", WINDOW),  # around the sample last measured
        ("unrest_window", WINDOW),  # around the last still one
        ("steps", np.int64),
        ("rest_norm_mps2", np.float64),  # what the accelerometer shows at rest
        ("temperature_degc", np.float64),  # smoothed; NaN while unknown
        ("temperature_s", np.float64),  # of the sample that had it
        ("bias_degc", np.float64),  # for which the gyroscope bias holds
        ("good_ns", np.int64),  # stamp of the last sample that was not bad
        ("began_at", np.int64),  # sample before which nothing is known of the motion
        ("began_s", np.float64),  # ... and its time
        # Strides like the hole before the sample that is filtered next; see similar_strides.
        ("similar_count", np.int64),
        ("similar_at", np.int64, SIMILAR_STRIDES),  # the sample after which it went on
        (
            "similar_distance_m2ps4",
            np.float64,
            SIMILAR_STRIDES,
        ),  # how unlike the samples around are
        ("similar_weight", np.float64, SIMILAR_STRIDES),
        ("in_stance", np.bool_),
        ("stance_since_s", np.float64),
        ("last_stance_s", np.float64),
        ("stance_least_m2ps4", np.float64),  # stillness statistic of this stance
        ("usual_stance_m2ps4", np.float64),  # ... of those before; see stance_acceptance
        ("restless_s", np.float64),  # when last less still than those
        ("gyro_saturated_s", np.float64),  # when last seen
        ("accel_saturated_s", np.float64),
        ("gap_s", np.float64),
        ("misfit_s", np.float64),
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
        ("level_constraint_suspended", np.bool_),  # by the barometer
        ("rise_bias_m", np.float64),  # by which a stride on the flat seems to sink
        ("flat_strides", np.float64),  # from which that is known
        ("climbed", np.float64),  # strides that left a level
        ("withheld_m", np.float64),  # what the floor has taken out in one direction
        ("past_ramps_m2", np.float64),  # in case what it took out before was a ramp
        ("ramp_evidence_m", np.float64),  # cumulative sum of what strides sink beyond half a ramp
        ("ramp_withheld_m", np.float64),  # what the floor has taken out since that was nought
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)


def new_filter_state() -> NDArray[Any]:
    """Return one record of ``FILTER``."""
    state = np.zeros(1, FILTER)
    state["quaternion_nb"][0] = [1.0, 0.0, 0.0, 0.0]
    state["rotation_nb"][0] = np.eye(3)
    state["scale_errors"]["covariance"][0] = np.eye(SCALE_ERRORS)
    state["faulty_stride"] = True
    state["clone"]["rows"] = CLONES
    state["compass"]["north_var_rad2"] = np.inf
    return state


def new_progress() -> NDArray[Any]:
    """Return one record of ``PROGRESS``."""
    progress = np.zeros(1, PROGRESS)
    for name in ("stance_since_s", "gyro_saturated_s", "accel_saturated_s", "gap_s", "misfit_s"):
        progress[name] = -1e9
    progress["temperature_degc"] = np.nan
    return progress
