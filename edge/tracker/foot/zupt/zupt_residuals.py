"""ZUPT residuals: quality of this sensor on this foot, from the velocity that a ZUPT finds at a
footfall.

The residual for each radian that the foot has turned shows an ordinary stride's noise.  The filter
weighs its measurements as if every stride were a hard one on a poor sensor, which gives the best
path, and the reported covariance is scaled by the residuals.  Strides with a fault (a gap,
saturation, a start on the move) and those before a rest has shown the gyroscope's bias are reported
in full.

The vertical residual shows the error of heel strikes.  A strike is over before many a sensor has
followed it.  The larger the residual, the more noise the force gets where samples do not follow the
motion (see integration): then a ZUPT corrects the strike, and not the swing before it, which would
end too high and too far.  Where saturation hid a part of the stride, the residual contains both,
and the strike gets its share of the variance.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, GYRO_BIAS, POSITION, VELOCITY
from edge.tracker.foot.filter.gap_turn import learn_gap_turn
from edge.tracker.foot.state import FilterState, Step
from edge.tracker.foot.zupt.zupt import lever_velocity_row
from edge.tracker.mechanization.strapdown import dot
from edge.tracker.preprocessing.sample_ring import Ring

SWING_RAD = 0.3  # that a foot turns at least in a stride; a crawling one hardly more


@njit()
def on_footfall(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Learn from the first still sample after a swing, before the stance corrects it."""
    if state.swing_rad < SWING_RAD:
        return
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
    row = step.lever_row[0]
    squares = 0.0
    for i in range(2):
        lever_velocity_row(state.rotation_nb, state.gyro_radps, i, row)
        residual_mps = dot(row, state.lever_b_m) - state.velocity_n_mps[i]
        squares += residual_mps * residual_mps
    shown = math.sqrt(squares) / state.swing_rad
    residual = min(shown, config.residuals.zupt_residual_max)
    lever_velocity_row(state.rotation_nb, state.gyro_radps, 2, row)
    down_mps = dot(row, state.lever_b_m) - state.velocity_n_mps[2]
    vertical_residual = min(abs(down_mps) / state.swing_rad, config.residuals.zupt_residual_max)
    state.zupt_residual_count = min(
        state.zupt_residual_count + 1.0, config.residuals.zupt_residual_memory
    )
    weight = 1.0 / (config.residuals.zupt_residual_prior_count + state.zupt_residual_count)
    state.mean_zupt_residual += weight * (residual - state.mean_zupt_residual)
    share = strike_share(state)
    state.strike_count = min(state.strike_count + share, config.residuals.zupt_residual_memory)
    state.mean_strike_residual += (
        share
        * (vertical_residual - state.mean_strike_residual)
        / (config.residuals.strike_prior_count + state.strike_count)
    )
    if state.swing_speed_mps > config.residuals.zupt_residual_slow_mps:
        slower = min(config.residuals.zupt_residual_speed_mps / state.swing_speed_mps, 1.0)
        state.mean_scale_residual += weight * (slower * residual - state.mean_scale_residual)
        shown = min(slower * shown, config.residuals.zupt_residual_max)
        _learn_gains(state, shown, weight, config)


@njit()
def _learn_gains(state: FilterState, residual: float, weight: float, config: EskfConfig) -> None:
    """Take a landing that shows the gains into the residual by which they are reported.

    Once there are enough landings the largest mean is held: gains are constant, and later landings
    show less of them.
    """
    state.gain_landing_count += 1.0
    state.mean_gain_residual += weight * (residual - state.mean_gain_residual)
    if state.zupt_residual_count < config.residuals.zupt_residual_memory:
        state.gain_residual = state.mean_gain_residual
    else:
        state.gain_residual = max(state.gain_residual, state.mean_gain_residual)


@njit()
def strike_share(state: FilterState) -> float:
    """Return the share of the vertical velocity's variance that no fault of the stride has made."""
    if not state.faulty_stride:
        return 1.0
    down = VELOCITY + 2
    return float(min(state.faultless_var_m2ps2 / state.covariance[down, down], 1.0))


@njit()
def on_lift_off(state: FilterState, config: EskfConfig) -> None:
    """Add the stride since the last lift-off to an ordinary walk's noise.

    The heading error that a fault has left goes on to make the distance wrong, so a stride's
    noise is ordinary by the share of the heading's variance that is.
    """
    p = state.covariance
    noise_m2 = p[POSITION, POSITION] + p[POSITION + 1, POSITION + 1]
    noise_rad2 = p[ATTITUDE + 2, ATTITUDE + 2]
    if not state.faulty_stride and _bias_is_known(state, config):
        state.ordinary_m2 += (noise_m2 - state.noise_m2) * _heading_share(state)
        state.ordinary_rad2 += noise_rad2 - state.noise_rad2
    state.ordinary_m2 = min(max(state.ordinary_m2, 0.0), noise_m2)
    state.ordinary_rad2 = min(max(state.ordinary_rad2, 0.0), noise_rad2)
    state.noise_m2 = noise_m2
    state.noise_rad2 = noise_rad2
    state.faulty_stride = False
    if state.gap_turn_is_new:
        learn_gap_turn(state)


@njit()
def _heading_share(state: FilterState) -> float:
    """Return the share of the heading's variance that strides without a fault have made."""
    if state.noise_rad2 <= 0.0:
        return 1.0
    return float(min(state.ordinary_rad2 / state.noise_rad2, 1.0))


@njit()
def _bias_is_known(state: FilterState, config: EskfConfig) -> bool:
    p = state.covariance
    worst = max(p[GYRO_BIAS, GYRO_BIAS], p[GYRO_BIAS + 1, GYRO_BIAS + 1])
    worst = max(worst, p[GYRO_BIAS + 2, GYRO_BIAS + 2])
    return bool(worst <= config.residuals.zupt_residual_bias_std_radps**2)


@njit()
def scale_error_inflation(state: FilterState, config: EskfConfig) -> float:
    """Return the factor on the variance of what gains do to a landing, as the last ones show it."""
    return _gain_share(state, state.mean_scale_residual, config)


@njit()
def reported_gain_inflation(state: FilterState, config: EskfConfig) -> float:
    """Return the factor on the variance of the gains, as all landings of this sensor show them.

    Few landings after fast swings leave a part of what a data sheet allows, none all of it.
    """
    shown = _gain_share(state, state.gain_residual, config)
    unseen = 1.0 - state.gain_landing_count / config.residuals.gain_landings
    return float(shown + max(unseen, 0.0) * max(1.0 - shown, 0.0))


@njit()
def _gain_share(state: FilterState, residual: float, config: EskfConfig) -> float:
    """Return the share of the assumed variance of the gains that a mean residual shows.

    A residual has a part by the gains and one that the best sensors have as well.  By 1 once a
    compass has been used, for it has observed the gains.
    """
    if state.scale_errors.compass_used:
        return 1.0
    quiet = config.residuals.zupt_residual_quiet**2
    shown = (residual**2 - quiet) / (config.residuals.zupt_residual_usual**2 - quiet)
    return float(max(shown, state.scale_errors.least_share))


@njit()
def noise_inflation(state: FilterState, config: EskfConfig) -> float:
    """Return the factor on the variance of the walk's noise.

    By 1 once a compass has been used: then its variance is most of that.
    """
    if state.noise_m2 <= 0.0 or state.scale_errors.compass_used:
        return 1.0
    ordinary = min(state.ordinary_m2 / state.noise_m2, 1.0)
    return float(
        1.0
        + ((state.mean_zupt_residual / config.residuals.zupt_residual_poor) ** 2 - 1.0) * ordinary
    )
