"""What is stated of a position: the filter's covariance, and what no filter sees.

Beside the noise of the walk these are systematic, and as wide as they make the walk wrong as a
whole: the gyroscope's gains turn it, those of the accelerometer make it too long or too short (and
too high), and
a heading that is wrong shortens it, whichever way it is wrong.  Before the foot has rested the
gyroscope's bias is doubted beside.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import SIZE, TURN, heading_variance
from edge.tracker.first_rest import unshown_heading_variance
from edge.tracker.gain_errors import along, project
from edge.tracker.landing import gain_scale, noise_scale
from edge.tracker.state import FilterState, Ring, Step


@njit()
def bend_way(state: FilterState, dt_s: float) -> None:
    """Take an interval along: the way it goes, times the variance of its heading.

    For large errors twice the mean of one minus the cosine takes the place of the variance.
    """
    heading_var = heading_variance(state.covariance) + unshown_heading_variance(state)
    variance = 2.0 * (1.0 - math.exp(-0.5 * heading_var))
    for i in range(2):
        state.bent_n_m[i] += variance * dt_s * state.velocity_n_mps[i]


@njit()
def state_position(
    ring: Ring, step: Step, state: FilterState, slot: int, open_s: float, config: EskfConfig
) -> None:
    """Write the stated covariance of a row's position, and the rows that the smoother needs.

    ``open_s``: for how long no good sample has come.
    """
    for i in range(10):
        for j in range(SIZE):
            step.covariance[i, j] = state.covariance[i, j]
    stated_m2 = ring[slot].position_cov_m2
    for i in range(3):
        for j in range(3):
            stated_m2[i, j] = state.covariance[i, j]
        stated_m2[i, i] += (config.gap_speed_std_mps * open_s) ** 2
    gains = state.gains
    for i in range(2):
        step.covariance[i, TURN] = along(gains.carried_m[i], gains.turned_column)
    stated_m2[2, 2] += (gains.std * state.position_n_m[2]) ** 2 + state.ramp_var_m2
    less = noise_scale(state, config) - 1.0
    worse = gain_scale(state, config)
    for j in range(2):
        project(gains, gains.carried_m[j], gains.column)
        for i in range(j, 2):
            more_m2 = less * state.covariance[i, j]
            more_m2 += worse * along(gains.carried_m[i], gains.column)
            more_m2 += worse * gains.std**2 * state.position_n_m[i] * state.position_n_m[j]
            more_m2 += state.unshown[i] * state.unshown[j]
            # A normal error's fourth moment is three times its variance squared.
            more_m2 += 0.75 * state.bent_n_m[i] * state.bent_n_m[j]
            stated_m2[i, j] += more_m2
            if i != j:
                stated_m2[j, i] += more_m2
