"""Memory of the body's tracker: one record, its ticks, and what rows wait for."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from edge.tracker.kernel_cache import SOURCES

BodyState: TypeAlias = Any  # one record of BODY
Sample: TypeAlias = Any  # one record of a ring
Ticks: TypeAlias = NDArray[Any]  # (TICKS,) of TICK
Trail: TypeAlias = NDArray[Any]  # as many of TRAIL as the ring has slots

TICK_S = 0.02
TICKS = 256  # a power of two: 2.56 s, longer than any step and its delay

# Errors of the path filter: position north and east, heading, gyroscope bias about the vertical,
# gain of turns, scale of the steps; then the field in uT: the earth's north and east in the path's
# frame, that of iron on the person in the sensor's axes, the bend here north and east.
NORTH, EAST, HEADING, BIAS, GAIN, SCALE = range(6)
FIELD, IRON, BEND = 6, 8, 11  # the first of two, three and two
ERRORS = 13

BODY = np.dtype(
    [
        ("received", np.int64),
        ("timed", np.int64),
        ("walked", np.int64),  # samples taken through attitude and steps
        ("released", np.int64),
        # attitude
        ("quaternion_nb", np.float64, 4),
        ("rotation_nb", np.float64, (3, 3)),
        ("gyro_bias_radps", np.float64, 3),
        ("bias_variance", np.float64),  # about each axis
        ("settled_s", np.float64),  # since attitude began, or began again
        ("heading_rad", np.float64),  # turned about the vertical, never wrapped
        ("reference_nb", np.float64, (3, 3)),  # an attitude from which the heading is counted
        ("reference_rad", np.float64),  # the heading there
        ("angle_b_rad", np.float64, 3),  # scratch
        ("force_n_mps2", np.float64, 3),  # of the sample; scratch
        # motion at the ticks
        ("low_pass_n_mps2", np.float64, (3, 3)),  # (stage, axis): north, east, up
        ("before_n_mps2", np.float64, 3),  # the last stage, at the sample before
        ("before_rad", np.float64),  # the heading there
        ("passed_rad", np.float64),  # the heading at the last tick
        ("ticks", np.int64),
        ("leaked_mps", np.float64),
        ("mean_mps", np.float64),
        # rest
        ("quiet_s", np.float64),
        ("up_mean_mps2", np.float64),
        ("moving_s", np.float64),  # without a step
        # steps
        ("armed", np.bool_),  # the velocity has been down since the last step
        ("rise_mps", np.float64),  # of the steps of late
        ("highest_mps", np.float64),  # since the last one
        ("event_s", np.float64),  # the last swing, a step or not
        ("swings", np.int64),  # of this walk
        ("step_count", np.int64),
        ("turned_s", np.float64, 2),  # ends of the last two steps
        ("turned_rad", np.float64, 2),  # ... and the heading there
        ("ended_down_m", np.float64, 2),  # ... and the height there
        ("last_step_s", np.float64),
        ("unusual_m", np.float64, 2),  # what one deviation of these steps makes, north and east
        # walking direction, north and east in the frame that turns with the heading
        ("direction", np.float64, 2),
        ("falling", np.float64, 2),  # the part in phase with the downward velocity
        ("phase_sums", np.float64, 4),  # scratch
        ("direction_weight", np.float64),
        ("in_hand", np.bool_),
        # swing of a thigh: its rate about level axes
        ("sample_swing_radps", np.float64),  # of the sample
        ("swing_radps", np.float64),  # mean of the steps of late
        ("swing_rates_radps", np.float64, TICKS),  # scratch
        ("in_pocket", np.bool_),
        # path filter
        ("estimate", np.float64, ERRORS),
        ("covariance", np.float64, (ERRORS, ERRORS)),
        ("row", np.float64, ERRORS),  # of a measurement; scratch
        ("gain", np.float64, ERRORS),  # scratch
        ("filtered_s", np.float64),  # the last compass measurement
        ("since_m", np.float64),  # walked since
        ("field_n_ut", np.float64, 2),  # low-passed
        ("level_nb", np.float64, (2, 3)),  # first rows of the attitude, low-passed alike
        ("field_seen", np.bool_),
        ("earth_ut", np.float64),  # as known here; 0 while unknown
        ("learned_ut", np.float64),  # the same, to be used from a sample's time on
        ("learned_from_ns", np.int64),
        # height
        ("pressure_pa", np.float64),  # low-passed; 0 before the first
        ("first_pressure_pa", np.float64),
        ("pressure_age_s", np.float64),  # since the last one
        ("down_m", np.float64),
        # rows
        ("position_n_m", np.float64, 2),
        ("distance_m", np.float64),
        ("fault_s", np.float64),  # time of the last fault
        ("faults", np.int64),  # Reason bits of it
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)

TICK = np.dtype(
    [
        ("t_s", np.float64),
        ("north_mps2", np.float64),
        ("east_mps2", np.float64),
        ("up_mps2", np.float64),
        ("rise_mps", np.float64),  # vertical velocity, without what is slower than steps
        ("heading_rad", np.float64),
        ("swing_radps", np.float64),  # about level axes
    ],
    align=True,
)

TRAIL = np.dtype(
    [
        ("heading_rad", np.float64),  # of the walk
        ("speed_mps", np.float64),
        ("down_m", np.float64),
    ],
    align=True,
)
