"""Reported covariance of a position: that of the filter, and errors that the filter does not model.

Beside the noise of the walk these are systematic, and as large as they move the walk as a whole:
scale errors of the gyroscope turn it, those of the accelerometer make it too long or too short (and
too high).  A heading error moves the way to one side by its sine and shortens it, whichever way it
is wrong: the filter states the error itself instead of the sine.  On a way that returns, its first
order may cancel where the others do not, so the second and third are stated beside it, of the whole
heading error that is stated, as one that is alike in sign all the way.  Before the foot has rested
the unobserved part of the gyroscope's bias is added, and so is what stances that contradict the
swings have left (see stance_consistency).
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, SIZE, TURN
from edge.tracker.foot.filter.error_model import heading_variance
from edge.tracker.foot.filter.gap_turn import forgotten_turn_variance
from edge.tracker.foot.filter.initial_gyro_bias import unobserved_heading_variance
from edge.tracker.foot.filter.scale_misalignment import along
from edge.tracker.foot.state import FilterState, Step
from edge.tracker.foot.zupt.zupt_residuals import noise_inflation, reported_gain_inflation
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def accumulate_heading_bias(state: FilterState, dt_s: float, config: EskfConfig) -> None:
    """Add the way of an interval times what its stated heading may do to it beyond the first order.

    For large errors twice the mean of one minus the cosine takes the place of the variance.
    """
    # A quiet walk has less noise than the filter's model, but no less doubt of a turn in a gap.
    inflation = max(noise_inflation(state, config), 1.0)
    heading_var = stated_heading_variance(state, inflation, config)
    variance = 2.0 * (1.0 - math.exp(-0.5 * heading_var))
    cube = variance * min(math.sqrt(heading_var), 1.0)
    north_m, east_m = dt_s * state.velocity_n_mps[0], dt_s * state.velocity_n_mps[1]
    state.second_order_n_m[0] += variance * north_m
    state.second_order_n_m[1] += variance * east_m
    state.third_order_n_m[0] -= cube * east_m
    state.third_order_n_m[1] += cube * north_m


@njit()
def stated_heading_variance(state: FilterState, inflation: float, config: EskfConfig) -> float:
    """Return the variance (rad^2) of the heading: the filter's, and what it does not model.

    ``inflation`` is the factor on the variance of the walk's noise.
    """
    p = state.covariance
    yaw = ATTITUDE + 2
    variance = heading_variance(p) + (inflation - 1.0) * p[yaw, yaw]
    variance += (reported_gain_inflation(state, config) - 1.0) * p[TURN, TURN]
    variance += unobserved_heading_variance(state) + state.hidden_turn_rad**2
    variance += forgotten_turn_variance(state)
    return float(max(variance, 0.0))


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
            more_m2 += state.gap_way_n_m[i] * state.gap_way_n_m[j]
            # Of a normal error the fourth moment is 3, the sixth 15 times the variance's power.
            more_m2 += 3.0 / 4.0 * state.second_order_n_m[i] * state.second_order_n_m[j]
            more_m2 += 15.0 / 36.0 * state.third_order_n_m[i] * state.third_order_n_m[j]
            reported_m2[i, j] += more_m2
            if i != j:
                reported_m2[j, i] += more_m2
