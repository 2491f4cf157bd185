"""Gyroscope bias before the first rest: reported as unknown, and corrected by the rest.

A start at rest shows the bias at once.  A start on the move does not: gravity shows it about the
level axes, but nothing about the vertical, for in stance a foot twists by one to five degrees a
second, differently for each person.  The filter then assumes the bias of a good sensor, which gives
the best path for those; reported is what a data sheet allows.

The filter believes that landings show the bias better than they can: each takes a part of it for
an error of the heading, which none can see (see gap_turn).  So what rests and landings can tell
is counted beside it, and no less of the bias is reported than that leaves.

If the first rest shows more than was expected, the bias is widened to that, and what it has done to
heading and position meanwhile is corrected, as far as that is linear.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, GYRO_BIAS, POSITION, SIZE, VELOCITY
from edge.tracker.foot.filter.bridge_scale import update_bridges
from edge.tracker.foot.filter.correction_tracking import widen_clone
from edge.tracker.foot.state import FilterState, Progress

OBSERVED_SHARE = 0.02  # of the variance at the start; less is known
NONLINEAR_RATIO_MAX = 2.2  # times the stated deviation; beyond, the walk is as good as lost


@njit()
def inflate_bias(state: FilterState, config: EskfConfig) -> None:
    """Write the effect of one standard deviation of the bias beyond what the filter assumes.

    ``unobserved_effect`` becomes that of north and east (m) and of the heading (rad).
    """
    if state.bias_observed:
        return
    variance = _update_least_known_axis(state)
    prior = config.start.gyro_bias_std_radps**2
    share = max(variance / prior, 1.0 / (1.0 + prior * state.bias_information_s2prad2))
    if share < OBSERVED_SHARE:
        state.bias_observed = True
        for i in range(3):
            state.unobserved_effect[i] = 0.0
        return
    state.unobserved_bias_std_radps = max(
        state.unobserved_bias_std_radps, _observed_bias_rms_radps(state)
    )
    scale = state.unobserved_bias_std_radps * min(share, 1.0) / variance
    state.unobserved_effect[0] = scale * _with_bias(state, POSITION, state.least_known_axis_b)
    state.unobserved_effect[1] = scale * _with_bias(state, POSITION + 1, state.least_known_axis_b)
    state.unobserved_effect[2] = scale * _with_bias(state, ATTITUDE + 2, state.least_known_axis_b)


@njit()
def _update_least_known_axis(state: FilterState) -> float:
    """Turn ``least_known_axis_b`` to where the bias is known least; return the variance along it.

    That is about the vertical, as the foot has stood so far: a person who gets up from a crawl
    has not shown what turned the heading meanwhile.  One step of the power iteration a
    sample follows it.
    """
    along = state.angle_rad  # as scratch
    square = 0.0
    for i in range(3):
        along[i] = _with_bias(state, GYRO_BIAS + i, state.least_known_axis_b)
        square += along[i] * along[i]
    for i in range(3):
        state.least_known_axis_b[i] = along[i] / math.sqrt(max(square, 1e-30))
    return _bias_variance(state, state.least_known_axis_b)


@njit()
def _observed_bias_rms_radps(state: FilterState) -> float:
    """Return the root mean square of the bias about the other two axes, which gravity shows.

    A sensor that is worse there than its kind is no better about the third.
    """
    square = 0.0
    along_least_known = 0.0
    for i in range(3):
        square += state.gyro_bias_radps[i] ** 2
        along_least_known += state.gyro_bias_radps[i] * state.least_known_axis_b[i]
    return math.sqrt(max(0.5 * (square - along_least_known * along_least_known), 0.0))


@njit()
def learn_from_stance(progress: Progress, state: FilterState, config: EskfConfig) -> None:
    """Take from a still sample what it shows of a bias that is not known, before it corrects."""
    if state.bias_observed:
        return
    if not progress.in_stance:
        inform_by_landing(progress, state)
    update_from_rest(state, config)


@njit()
def update_from_rest(state: FilterState, config: EskfConfig) -> None:
    """Widen the bias to what the first rest shows, where that is more than was expected.

    Everything the bias has moved is widened along with it, so that the stance corrects all of it.
    """
    off = state.angle_rad  # as scratch
    square = 0.0
    for i in range(3):
        off[i] = state.rest_rate_radps[i] - state.gyro_bias_radps[i]
        square += off[i] * off[i]
    expected = config.start.gyro_bias_gate * config.start.gyro_bias_std_radps
    # A foot that sways scatters by half of its mean rate at least.
    scattered = state.rest_rate_var_rad2ps2 > config.start.rest_rate_scatter**2 * square
    if scattered or square <= expected**2:
        return
    variance = _bias_variance(state, off) / square
    if variance >= square:
        return
    reported = max(state.unobserved_bias_std_radps, config.start.gyro_bias_std_radps)
    if square > reported**2:
        ratio = min(math.sqrt(square) / reported, NONLINEAR_RATIO_MAX)
        for i in range(2):  # what is not linear was stated for one deviation
            state.second_order_n_m[i] *= ratio**2
            state.third_order_n_m[i] *= ratio**3
        state.unobserved_bias_std_radps = math.sqrt(square)
    for i in range(SIZE):
        state.column[i] = _with_bias(state, i, off) / variance
    widen_clone(state, off, 1.0 / variance)
    update_bridges(state, -1.0)
    for i in range(SIZE):
        for j in range(SIZE):
            state.covariance[i, j] += state.column[i] * state.column[j]


@njit()
def inform_by_landing(progress: Progress, state: FilterState) -> None:
    """Count what the first still sample after a stride can tell of the bias, before it does.

    A bias turns the velocity of the swing along with the foot: at the landing the velocity is off
    by the bias times the way, across it.
    """
    north_m = state.position_n_m[0] - progress.foothold_north_m
    east_m = state.position_n_m[1] - progress.foothold_east_m
    p = state.covariance
    variance = 0.5 * (p[VELOCITY, VELOCITY] + p[VELOCITY + 1, VELOCITY + 1])
    state.bias_information_s2prad2 += (north_m * north_m + east_m * east_m) / variance


@njit()
def inform_by_rest(state: FilterState, rate_variance: float) -> None:
    """Count what a measurement of the rate at rest tells of the bias."""
    state.bias_information_s2prad2 += 1.0 / rate_variance


@njit()
def is_bias_unobserved(state: FilterState, config: EskfConfig) -> bool:
    """True while the bias, and with it the heading, is less certain than the covariance says."""
    beyond = state.unobserved_bias_std_radps > config.start.gyro_bias_std_radps
    return bool(beyond and not state.bias_observed)


@njit()
def unobserved_heading_variance(state: FilterState) -> float:
    return float(state.unobserved_effect[2] * state.unobserved_effect[2])


@njit()
def _with_bias(state: FilterState, index: int, direction: Floats) -> float:
    """Return the covariance of error ``index`` with the bias along ``direction`` (3,)."""
    row = state.covariance[index]
    total = 0.0
    for i in range(3):
        total += row[GYRO_BIAS + i] * direction[i]
    return total


@njit()
def _bias_variance(state: FilterState, direction: Floats) -> float:
    total = 0.0
    for i in range(3):
        total += direction[i] * _with_bias(state, GYRO_BIAS + i, direction)
    return float(max(total, 1e-12))
