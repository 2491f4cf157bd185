"""Parameters and memory of the waist's tracker."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from edge.tracker.trunk.state import TRUNK, TrunkConfig
from edge.tracker.trunk.usual_steps import UsualSteps

WaistState: TypeAlias = Any  # one record of WAIST

WAIST = np.dtype(
    [
        ("trunk", TRUNK),
        ("window_from", np.int64),  # first sample in the sliding window
        ("window_to", np.int64),  # one past the last
        ("window_sum_mps2", np.float64),  # of the sizes of its forces
        ("peak_mps2", np.float64),  # highest since the last zero crossing, above the mean
        ("peak_at", np.int64),
        ("passed_over", np.int64),  # peaks since the last step that came too early for one
        ("step_at", np.int64),  # peak of the last step
        ("step_s", np.float64),
        ("step_height_m", np.float64),
        ("walking", np.bool_),  # the last step was not long ago
        ("first_m", np.float64),  # length of a walk's first step, until its period is known
    ],
    align=True,
)


class WaistConfig(NamedTuple):
    """Step lengths as published; the paper leaves the thresholds of its detector open."""

    trunk: TrunkConfig = TrunkConfig()
    half_window_s: float = 0.1
    peak_mps2: float = 0.5  # a lower one is no step
    least_period_s: float = 0.33
    longest_period_s: float = 1.1  # longer: the wearer stood in between
    usual: UsualSteps = UsualSteps()
