"""Parameters and memory of the hip's tracker."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.tracker.trunk.state import TRUNK, TrunkConfig
from edge.tracker.trunk.usual_steps import UsualSteps

HipState: TypeAlias = Any  # one record of HIP

NO_MODEL, GAUSSIAN, SINUSOIDAL, SAWTOOTH = range(4)  # without a model: step and heading
SCARLETT, WEINBERG, KIM = range(3)

HIP = np.dtype(
    [
        ("trunk", TRUNK),
        # Step machine; see step_machine.py.
        ("phase", np.int64),
        ("smoothed_mps2", np.float64),  # size of the force
        ("began_at", np.int64),  # sample at which this step began
        ("highest_mps2", np.float64),  # of the force in this step
        ("lowest_mps2", np.float64),
        ("sum_mps2", np.float64),
        ("swing_sum_mps2", np.float64),  # of the size of what gravity does not explain
        ("samples", np.int64),
        ("passed_over", np.int64),  # rounds since the last step that ended too early for one
        ("step_at", np.int64),  # end of the last step
        ("step_s", np.float64),
        ("step_height_m", np.float64),
        ("walking", np.bool_),  # the last step was not long ago
        # Filter of distance and velocity along the way, and that of heading and turn rate.
        ("velocity_mps", np.float64),
        ("force_bias_mps2", np.float64),  # mean force along the way
        ("way_cov", np.float64, (2, 2)),
        ("turn_cov", np.float64, (2, 2)),
        # What the heading has done of late; see indoor_constraints.py.
        ("heading_rad", np.float64),  # of the last step, without jumps of a whole turn
        ("before_rad", np.float64),  # of the one before it
        ("straight_from_s", np.float64),
        ("straight_rad", np.float64),  # heading of this straight way
        ("corridor_rad", np.float64),  # heading of the straight way before it
        ("straight", np.bool_),
        ("held", np.bool_),  # a constraint holds on this way
        ("has_corridor", np.bool_),
    ],
    align=True,
)


class HipConfig(NamedTuple):
    """Shapes of the velocity as published; constants of a person by a walk of known length.

    ``straight_walks`` and ``right_angles`` assume a building of straight corridors that meet at
    right angles, and are wrong anywhere else.
    """

    trunk: TrunkConfig = TrunkConfig()
    velocity_model: int = GAUSSIAN
    step_length: int = SCARLETT
    straight_walks: bool = False
    right_angles: bool = False
    # Step machine: what the size of the force is above and below gravity.
    start_mps2: float = 0.4
    positive_peak_mps2: float = 0.8
    negative_peak_mps2: float = -0.8
    end_mps2: float = -0.4
    smooth_s: float = 0.03
    least_period_s: float = 0.33
    longest_period_s: float = 1.1
    # Step lengths (2.1 to 2.3).
    scarlett_m: float = 1.27
    weinberg: float = 0.453
    kim: float = 0.607
    # Velocity models (3.3 to 3.5).
    gaussian_shift_mps: float = 0.9
    gaussian_m: float = 0.515
    gaussian_peak: float = 0.4  # of the step
    gaussian_width: float = 0.15
    sinusoidal_mps2: float = 2.08
    sinusoidal_mps: float = 0.25
    sawtooth_mps2: float = 2.26
    sawtooth_mps: float = 0.2
    sawtooth_peak: float = 0.25
    # Error-state filter (3.11 to 3.20).
    corrections: int = 2  # a step: the thesis's 4 % of its samples
    force_noise_m2ps3: float = 0.1
    bias_share: float = 0.2  # of the mean force of a step, in that of all
    model_std_mps: float = 0.1
    turn_noise_rad2ps: float = 1e-3
    turn_bias_noise_rad2ps3: float = 1e-6
    constraint_std_rad: float = 0.05
    # Spatial constraints (section 3.3.1).
    straight_radps: float = 0.12
    straight_s: float = 3.0
    corner_rad: float = 0.5  # within which a turn between two straight ways is a right angle
    usual: UsualSteps = UsualSteps()
