"""Parameters and memory that the trackers of the trunk share."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.samples import SensorDescription
from edge.tracker.kernel_cache import SOURCES
from edge.tracker.trunk.unseen_motion import UnseenMotion

TrunkState: TypeAlias = Any  # one record of TRUNK
Row: TypeAlias = Any  # one record of a ring

TRUNK = np.dtype(
    [
        ("received", np.int64),
        ("timed", np.int64),
        ("walked", np.int64),  # samples taken through attitude, height and steps
        ("released", np.int64),
        # Attitude; see attitude.py.
        ("quaternion_nb", np.float64, 4),
        ("rotation_nb", np.float64, (3, 3)),
        ("forward_b", np.float64, 3),  # sensor axis that is taken for the wearer's front
        ("gyro_bias_radps", np.float64, 3),
        ("bias_s", np.float64),  # for how long rests have shown it
        ("quiet_s", np.float64),  # since when nothing has moved
        ("rest_norm_mps2", np.float64),  # of the specific force, a slow mean
        ("field_s", np.float64),  # time of the last field
        ("still", np.bool_),
        ("has_compass", np.bool_),  # a calibrated one
        # Height; see pressure_height.py.
        ("height_m", np.float64),
        ("reference_m", np.float64),  # pressure height of the start
        ("pressure_s", np.float64),  # time of the last pressure
        ("began_s", np.float64),  # time of the first
        ("has_pressure", np.bool_),
        # Dead reckoning; see dead_reckoning.py.
        ("position_n_m", np.float64, 3),
        ("length_error_m", np.float64, 2),  # what one deviation of the step length would make
        ("heading_error_m", np.float64, 2),  # ... of the heading
        ("facing_n", np.float64, 2),  # where the last step went
        ("moving_s", np.float64),  # since a rest or a step
        ("random_m2", np.float64),  # what differs from step to step
        ("distance_m", np.float64),
        ("steps", np.int64),  # of both feet
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)


class TrunkConfig(NamedTuple):
    """Parameters of attitude, height and stated errors."""

    gravity_mps2: float = 9.80665
    low_pass_s: float = 0.24  # Hann window of the first acceleration
    tilt_per_s: float = 0.15  # of the angle between felt and assumed gravity, corrected
    tilt_at_rest_per_s: float = 1.5
    compass_per_s: float = 0.12  # of the angle to magnetic north, corrected
    quiet_radps: float = 0.12
    quiet_mps2: float = 0.35  # of the force's size, about its mean
    rest_s: float = 0.6  # quiet for so long is rest
    bias_memory_s: float = 30.0
    bias_known_s: float = 1.5
    norm_memory_s: float = 4.0
    gap_s: float = 0.1
    saturation_ratio: float = 0.985
    late_delivery_s: float = 0.04
    lookahead_s: float = 0.14
    hold_s: float = 0.9  # rows wait so long for the end of their step
    pressure_smooth_s: float = 1.0
    height_std_m: float = 0.3  # doors, gusts
    height_walk_mpsqs: float = 0.025  # weather and warming
    level_error_per_distance: float = 0.1  # without a barometer all ways are taken for level
    length_std: float = 0.18  # of a step length that was learnt from other people
    step_std: float = 0.1  # from step to step
    turn_step_std: float = 0.8  # ... where the wearer turns by a right angle, besides
    start_std_m: float = 0.55  # of the first and the last step of a walk
    place_std_m: float = 0.1
    # What differs from step to step, by the way: of its own covariance, the median of twelve walks
    # on floors with turns and halts (waist 0.22, hip 0.21).
    path_std_m_per_sqrt_m: float = 0.21
    compass_std_rad: float = 0.15
    unknown_bias_radps: float = 0.0175
    known_bias_radps: float = 0.0012
    heading_std_rad: float = 0.03
    unseen: UnseenMotion = UnseenMotion()
    degraded_m: float = 3.0
    lost_m: float = 15.0


def begin_trunk(trunk: Any, description: SensorDescription) -> None:
    """Set the beginning of a record of ``TRUNK``."""
    trunk["quaternion_nb"][0] = 1.0
    trunk["forward_b"][0] = 1.0
    trunk["rest_norm_mps2"] = TrunkConfig().gravity_mps2
    trunk["has_compass"] = description.mag_present and description.mag_iron_std_ut is not None
