"""Reported covariance of a position: that of the filter, and errors that the filter does not model.

Beside the noise of the walk these are systematic, and as large as they move the walk as a whole:
scale errors of the gyroscope turn it, those of the accelerometer make it too long or too short (and
too high), and a heading error shortens it, whichever way it is wrong.  Before the foot has rested
the unobserved part of the gyroscope's bias is added, and so is what stances that contradict the
swings have left (see stance_consistency).
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import SIZE, TURN
from edge.tracker.foot.filter.error_model import heading_variance
from edge.tracker.foot.filter.initial_gyro_bias import unobserved_heading_variance
from edge.tracker.foot.filter.scale_misalignment import along
from edge.tracker.foot.state import FilterState, Step
from edge.tracker.foot.zupt.zupt_residuals import noise_inflation, reported_gain_inflation
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def accumulate_heading_bias(state: FilterState, dt_s: float, config: EskfConfig) -> None:
    """Add the distance of an interval times the variance of its heading.

    For large errors twice the mean of one minus the cosine takes the place of the variance.
    """
    p = state.covariance
    heading_var = heading_variance(p) + unobserved_heading_variance(state)
    heading_var += (reported_gain_inflation(state, config) - 1.0) * p[TURN, TURN]
    heading_var = max(heading_var, 0.0)
    variance = 2.0 * (1.0 - math.exp(-0.5 * heading_var))
    for i in range(2):
        state.nonlinear_n_m[i] += variance * dt_s * state.velocity_n_mps[i]


@njit()
def report_covariance(
    ring: Ring, step: Step, state: FilterState, slot: int, open_s: float, config: EskfConfig
) -> None:
    """Write the reported covariance of a row's position, and the rows that the smoother needs.

    ``open_s``: for how long no good sample has come.
    """
    for i in range(10):
        for j in range(SIZE):
            step.covariance[i, j] = state.covariance[i, j]
    reported_m2 = ring[slot].position_cov_m2
    for i in range(3):
        for j in range(3):
            reported_m2[i, j] = state.covariance[i, j]
        reported_m2[i, i] += (config.restart.speed_std_mps * open_s) ** 2 + state.misfit_n_m[i] ** 2
        reported_m2[i, i] += config.output.report_floor_m**2
    scale_errors = state.scale_errors
    for i in range(2):
        step.covariance[i, TURN] = along(
            scale_errors.position_sensitivity[i], scale_errors.heading_column
        )
    reported_m2[2, 2] += (scale_errors.std * state.position_n_m[2]) ** 2 + state.ramp_var_m2
    reported_m2[2, 2] += state.hidden_rise_m**2
    noise_excess = noise_inflation(state, config) - 1.0
    scale_excess = reported_gain_inflation(state, config)
    length_excess = max(scale_excess, 1.0)  # a scale of the accelerometer leaves landings alone
    for j in range(2):
        for i in range(j, 2):
            more_m2 = noise_excess * state.covariance[i, j]
            more_m2 += scale_excess * along(
                scale_errors.position_sensitivity[i], scale_errors.position_column[j]
            )
            more_m2 += (
                length_excess * scale_errors.std**2 * state.position_n_m[i] * state.position_n_m[j]
            )
            more_m2 += state.unobserved_effect[i] * state.unobserved_effect[j]
            more_m2 += state.hidden_way_n_m[i] * state.hidden_way_n_m[j]
            # A normal error's fourth moment is three times its variance squared.
            more_m2 += 0.75 * state.nonlinear_n_m[i] * state.nonlinear_n_m[j]
            reported_m2[i, j] += more_m2
            if i != j:
                reported_m2[j, i] += more_m2
