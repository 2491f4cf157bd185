"""How good this sensor on this foot is, as the landings show.

A stance finds the velocity that the swing before it has brought along.  How far that is off, for
each radian that the foot has turned, tells an ordinary stride's noise: the filter weighs its
measurements as if every stride were a hard one on a poor sensor, which finds the best path, and
what is stated is scaled by the landings.  What came with a fault (a gap, clipping, a start on the
move) or before a rest has shown the gyroscope's bias is stated in full.

How far the vertical velocity is off tells what heel strikes have left.  A strike is over before
many a sensor has followed it.  The worse it leaves the landings, the more is the force doubted
where samples do not follow the motion (see intervals): then a landing puts the strike right, and
not the swing before it, which would end too high and too far.  Where clipping hid a part of the
stride, a landing tells of both, and of the strike by its share of the variance.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE, GYRO_BIAS, POSITION, VELOCITY
from edge.tracker.stance import lever_velocity_row
from edge.tracker.state import FilterState, Ring, Step
from edge.tracker.strapdown import dot

SWING_RAD = 0.3  # that a foot turns at least in a stride; a crawling one hardly more


@njit()
def land(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Learn from the first still sample after a swing, before the stance corrects it."""
    if state.swing_rad < SWING_RAD:
        return
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
    row = step.lever_row[0]
    squares = 0.0
    for i in range(2):
        lever_velocity_row(state.rotation_nb, state.gyro_radps, i, row)
        off_mps = dot(row, state.lever_b_m) - state.velocity_n_mps[i]
        squares += off_mps * off_mps
    off = min(math.sqrt(squares) / state.swing_rad, config.landing_off_most)
    lever_velocity_row(state.rotation_nb, state.gyro_radps, 2, row)
    down_mps = dot(row, state.lever_b_m) - state.velocity_n_mps[2]
    struck = min(abs(down_mps) / state.swing_rad, config.landing_off_most)
    state.landings = min(state.landings + 1.0, config.landing_memory)
    weight = 1.0 / (config.landing_worth + state.landings)
    state.landing_off += weight * (off - state.landing_off)
    share = strike_share(state)
    state.strikes = min(state.strikes + share, config.landing_memory)
    state.strike_off += share * (struck - state.strike_off) / (config.strike_worth + state.strikes)
    if state.swing_speed_mps > config.landing_slow_mps:
        off *= min(config.landing_speed_mps / state.swing_speed_mps, 1.0)
        state.gain_off += weight * (off - state.gain_off)


@njit()
def strike_share(state: FilterState) -> float:
    """Return the share of the vertical velocity's variance that no fault of the stride has made."""
    if not state.faulty_stride:
        return 1.0
    down = VELOCITY + 2
    return float(min(state.faultless_var_m2ps2 / state.covariance[down, down], 1.0))


@njit()
def lift_off(state: FilterState, config: EskfConfig) -> None:
    """Tell what the stride since the last lift-off has added to an ordinary walk's noise.

    The heading that a fault has left in doubt goes on to make the way wrong, so a stride's
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
    return bool(worst <= config.landing_bias_std_radps**2)


@njit()
def gain_scale(state: FilterState, config: EskfConfig) -> float:
    """Return by what the variance of the gains is to be multiplied: what is poor lands badly.

    By 1 once a compass has been heard, for then it has told of them.
    """
    if state.gains.heard:
        return 1.0
    return float(max(1.0, (state.gain_off / config.landing_off_usual) ** 2))


@njit()
def noise_scale(state: FilterState, config: EskfConfig) -> float:
    """Return by what the variance of the walk's noise is to be multiplied.

    By 1 once a compass has been heard: then its doubts make up most of that variance.
    """
    if state.noise_m2 <= 0.0 or state.gains.heard:
        return 1.0
    ordinary = min(state.ordinary_m2 / state.noise_m2, 1.0)
    return float(1.0 + ((state.landing_off / config.landing_off_poor) ** 2 - 1.0) * ordinary)
