"""Parameters and memory of the fusion of two paths.

Errors of each path are those of its place (north, east), of its heading and of its lengths.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.tracker.interface import MOST_LAG_S
from edge.tracker.kernel_cache import SOURCES

PathState: TypeAlias = Any  # one record of PATH
FusionState: TypeAlias = Any  # one record of FUSION

NORTH, EAST, HEADING, LENGTH = range(4)
ERRORS = 4  # of one path
LEAD, OTHER = 0, 1

PATH = np.dtype(
    [
        # The path as its own tracker has it.
        ("seen", np.bool_),
        ("t_ns", np.int64),  # of its last row
        ("position_n_m", np.float64, 3),
        ("velocity_n_mps", np.float64, 3),
        ("past_shift_n_m", np.float64, 2),
        ("past_turn_rad", np.float64),
        ("distance_m", np.float64),
        ("steps", np.int64),
        ("stationary", np.bool_),
        ("quality", np.uint8),
        ("heading_std_rad", np.float64),
        ("position_m2", np.float64),  # trace of its horizontal covariance
        ("height_m2", np.float64),
        # The same in the fused frame.
        ("aligned", np.bool_),
        ("turn_rad", np.float64),  # from its own frame, clockwise
        ("scale", np.float64),
        ("place_n_m", np.float64, 2),
        ("since_n_m", np.float64, 2),  # way of the other path since its last row
        ("weight", np.float64),
        # Since the last stride.
        ("way_n_m", np.float64, 2),
        ("heading_rad2", np.float64),  # by which its heading has become less sure
        ("poor", np.int64),  # rows that were not good
        # What its own errors alone would make of it, to see where its tracker states more.
        ("alone", np.float64, (ERRORS, ERRORS)),
        ("widening_m2", np.float64),  # slow mean of what a stride adds to its covariance
        ("alignment_n_m", np.float64, 2),  # way since both began, own frame
    ],
    align=True,
)

FUSION = np.dtype(
    [
        ("paths", PATH, 2),
        ("covariance", np.float64, (2 * ERRORS, 2 * ERRORS)),
        ("began_ns", np.int64),
        ("begun", np.bool_),
        ("past_shift_n_m", np.float64, 2),
        ("past_turn_rad", np.float64),
        ("distance_m", np.float64),
        ("strides", np.int64),
        # Since the last stride of the leading sensor.
        ("apart_n_m", np.float64, 2),  # sum of what lies between the two
        ("rows", np.int64),
        ("stride_ns", np.int64),
        ("stride_steps", np.int64),
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ],
    align=True,
)


class FusionConfig(NamedTuple):
    """Parameters of the fusion; ``length_std`` and ``share`` are of the leading path, and the
    other.
    """

    length_std: tuple[float, float] = (0.003, 0.003)
    share: tuple[float, float] = (0.5, 0.5)  # of the two in the fused place, if equally sure
    apart_std_m: float = 0.3  # of the mean of what lies between the two over a stride
    # The same as if each stride showed it anew; it is alike in many, and so has less weight.
    compared_std_m: float = 1.2
    # What a stride adds to the errors, as a share of its length and as a turn, while its tracker
    # states good, degraded and lost quality.
    stride_std: tuple[float, float, float] = (0.01, 0.05, 0.3)
    stride_turn_rad: tuple[float, float, float] = (0.0, 0.02, 0.1)
    heading_walk_rad2ps: float = 1e-6
    longest_stride_s: float = 2.0
    least_way_m: float = 0.3  # that counts as a stride where none is felt
    alignment_m: float = 2.0  # both have gone so far when their headings are compared
    alignment_apart_m: float = 0.4  # what lies between them differs by as much meanwhile
    outlier_square: float = 9.21  # chi-square, 2 degrees of freedom, 99 %
    widening_memory: float = 0.3  # of a stride, in the slow mean
    least_widening_m2: float = 1e-4
    place_std_m: float = 0.05
    silence_s: float = 0.35
    forgotten_s: float = 3.0  # silent for longer: its heading is compared anew
    lag_s: float = MOST_LAG_S
    degraded_m: float = 3.0
    lost_m: float = 15.0
