"""Parameters and memory of the tracker of torso and shank."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.tracker.interface import MOST_LAG_S, BodyDimensions
from edge.tracker.trunk.state import TRUNK, TrunkConfig
from edge.tracker.waist.state import WAIST, WaistConfig

ShankState: TypeAlias = Any  # one record of SHANK
StrideState: TypeAlias = Any  # one record of TORSO_SHANK

SHANK = np.dtype(
    [
        ("trunk", TRUNK),  # its attitude by the same filter as the torso's
        ("walked_ns", np.int64),  # time of the last sample taken
        ("leg_b", np.float64, 3),  # up along the leg, sensor axes
        ("leg_s", np.float64),  # for how long rests have shown it
        ("rate_products", np.float64, (3, 3)),  # slow mean of rate times rate, across the leg
        ("hinge_b", np.float64, 3),  # axis about which the leg swings; stance turns forward
        ("skewness", np.float64),  # slow mean of the cube of the rate about it
        ("pitch_rad", np.float64),  # of the leg, forward positive
        # What has been found since the torso last looked.
        ("has_instant", np.bool_),
        ("instant_radps", np.float64),
    ],
    align=True,
)

TORSO_SHANK = np.dtype(
    [
        ("waist", WAIST),  # attitude, dead reckoning, and steps for where the shank is gone
        ("leg_length_m", np.float64),
        ("leg_std", np.float64),  # of that length and of the model, as a share
        # Stride since the last vertical-straight-line instant; see stride.py.
        ("walking", np.bool_),
        ("by_steps", np.bool_),  # the shank shows no instants: the torso's steps count
        ("begin_at", np.int64),  # sample of the instant
        ("begin_s", np.float64),
        ("begin_n_m", np.float64, 2),
        ("begin_height_m", np.float64),
        ("begin_distance_m", np.float64),
        ("begin_n_mps", np.float64, 2),
        ("velocity_n_mps", np.float64, 2),
        # Where the torso's front is, against the axis taken for it; see torso_front.py.
        ("pushed_n_mps", np.float64, 2),  # acceleration since the stride began, added up
        ("front", np.float64, 2),  # cosine and sine, times the square of changes of velocity
        ("front_m2ps2", np.float64),  # sum of those squares
        # Way since the last instant, and of late, by the torso's steps; see torso_steps.py.
        ("steps_m", np.float64),  # way by the torso's steps ...
        ("strides_m", np.float64),  # ... and by the shank, of late: their ratio is learnt
        ("steps_since_m", np.float64),  # since the last instant
        ("steps_since", np.int64),
        ("first_step_s", np.float64),  # of those
        ("counted_at", np.int64),  # sample to which the way is counted, where steps count
    ],
    align=True,
)


class TorsoShankConfig(NamedTuple):
    """The thesis leaves the thresholds of its detector open."""

    trunk: TrunkConfig = TrunkConfig(
        step_std=0.05,
        turn_step_std=0.3,
        start_std_m=0.25,
        path_std_m_per_sqrt_m=0.11,  # the waist's, with these deviations and learnt_step_std
        hold_s=0.7,
    )
    waist: WaistConfig = WaistConfig()
    # Vertical-straight-line instant (4.2.1).
    average_s: float = 0.1  # of the rate's moving average
    area_s: float = 0.15  # on either side, in which the rate has its minimum
    above_least: float = 1.5  # of that minimum, at most ...
    above_radps: float = 0.4  # ... and so much
    least_radps: float = 0.3
    most_radps: float = 4.0
    hinge_memory_s: float = 15.0
    leg_tilt_rad: float = 0.5  # a rest farther from upright is one on the knee
    leg_memory_s: float = 10.0
    quiet_s: float = 0.3  # a shank that is quiet for so long stands ...
    lost_quiet_s: float = 1.5  # ... but for one so long while the torso steps
    # Stride (4.9 to 4.13).
    longest_stride_s: float = 1.8
    first_stride_s: float = 1.0  # from standing to an even speed
    first_step_s: float = 0.5  # before a walk's first step is felt
    steps_alone: int = 4  # of the torso, without an instant: the shank does not show its strides
    learnt_step_std: float = 0.08  # of a step's length, besides
    front_memory: float = 50.0  # strides
    front_m2ps2: float = 0.5  # squares of changes of velocity that show it
    front_agreement: float = 0.5  # of the acceleration with them
    ratio_memory_m: float = 30.0
    # Silence of the shank: longer than the gaps that a foot's tracker bridges.
    silence_s: float = 0.35
    lag_s: float = MOST_LAG_S
    # Leg length.
    leg_of_height: float = 0.53  # hip joint above the sole (Drillis and Contini 1966)
    usual_height_m: float = 1.75
    known_leg_std: float = 0.05  # what the model is off by
    height_leg_std: float = 0.07
    usual_leg_std: float = 0.1


def leg_length_m(dimensions: BodyDimensions, config: TorsoShankConfig) -> tuple[float, float]:
    """Return the length of a leg and its stated deviation as a share, by the best that is known.

    A length that nobody has is not used.
    """
    if dimensions.leg_length_m is not None and not dimensions.is_leg_implausible:
        return dimensions.leg_length_m, config.known_leg_std
    if dimensions.height_m is not None:
        return config.leg_of_height * dimensions.height_m, config.height_leg_std
    return config.leg_of_height * config.usual_height_m, config.usual_leg_std
