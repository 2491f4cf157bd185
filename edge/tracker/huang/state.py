"""Parameters and memory of the thesis's tracker (huang)."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.tracker.kernel_cache import SOURCES

HuangState: TypeAlias = Any  # one record of HUANG

HUANG = np.dtype(
    [
        ("received", np.int64),
        ("timed", np.int64),
        ("walked", np.int64),  # samples taken through stance and swing
        ("released", np.int64),
        ("reset_at", np.int64),  # sample of the last reset
        ("swing_from", np.int64),  # last stance sample before the swing
        ("stance_from", np.int64),  # first stance sample after it
        ("in_stance", np.bool_),
        ("settled", np.bool_),  # this stance has had its reset
        ("reset_position_n_m", np.float64, 3),
        ("reset_quaternion_nb", np.float64, 4),
        ("rate_spread", np.float64, (3, 3)),  # running mean of w w', whose main axis is the pitch
        ("pitch_axis_b", np.float64, 3),
        ("position_n_m", np.float64, 3),
        ("velocity_n_mps", np.float64, 3),
        ("quaternion_nb", np.float64, 4),
        ("rotation_nb", np.float64, (3, 3)),
        ("foothold_n_m", np.float64, 3),
        ("distance_m", np.float64),
        ("steps", np.int64),
        ("last_stance_s", np.float64),
        ("declination_rad", np.float64),  # of magnetic north, east positive; 0 while unknown
        ("learned_rad", np.float64),  # the same, to be used from a sample's time on
        ("learned_from_ns", np.int64),
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)


class HuangConfig(NamedTuple):
    """Phase times and thresholds; the thesis gives none, these are for walking."""

    gravity_mps2: float = 9.80665
    stance_rate_radps: float = 0.6  # about the pitch axis
    least_stance_s: float = 0.12  # shorter is a zero crossing within a swing
    settle_s: float = 0.2  # from the start of a stance to its reset
    rest_s: float = 1.0  # between resets of someone who stands
    longest_swing_s: float = 1.2  # then the quietest sample around is taken for stance
    low_pass_s: float = 0.7  # Hann window of the acceleration: 1 Hz
    axis_memory_s: float = 5.0
    lookahead_s: float = 0.36
    hold_s: float = 0.55  # a swing's rows wait so long for its correction
    late_delivery_s: float = 0.04
    gap_s: float = 0.1
    saturation_ratio: float = 0.985
    error_per_distance: float = 0.02  # the thesis's result
    heading_std_rad: float = 0.09
    no_stance_s: float = 3.0
