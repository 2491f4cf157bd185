"""What is not known of the gyroscope's bias before the foot has rested.

Who stands still first shows it.  Who starts on the move does not: gravity tells it about the
level axes, but about the vertical nothing does, for in stance a foot twists by one to five
degrees a second, each wearer's by a habit of its own.  The filter then takes the bias for as small
as good sensors have it, which finds the best path of those; stated is what a data sheet allows.

The first rest tells.  Shows it more than was to be expected it is believed, and what the bias
has done to heading and position meanwhile is put right, as far as that is linear.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE, GYRO_BIAS, POSITION, SIZE
from edge.tracker.past import widen_past
from edge.tracker.state import FilterState

SHOWN_SHARE = 0.02  # of the variance at the start; less is known
BENT_MOST = 5.0  # times what was stated; beyond, the walk is as good as lost


@njit()
def doubt_bias(state: FilterState, config: EskfConfig) -> None:
    """Write what one deviation of the bias, beyond what the filter takes it for, has done.

    ``unshown`` becomes that of north and east (m) and of the heading (rad).
    """
    if state.bias_shown:
        return
    variance = _least_known(state)
    share = variance / config.start_gyro_bias_std_radps**2
    if share < SHOWN_SHARE:
        state.bias_shown = True
        for i in range(3):
            state.unshown[i] = 0.0
        return
    state.unshown_bias_std_radps = max(state.unshown_bias_std_radps, _seen_bias_radps(state))
    scale = state.unshown_bias_std_radps * min(share, 1.0) / variance
    state.unshown[0] = scale * _with_bias(state, POSITION, state.doubted_b)
    state.unshown[1] = scale * _with_bias(state, POSITION + 1, state.doubted_b)
    state.unshown[2] = scale * _with_bias(state, ATTITUDE + 2, state.doubted_b)


@njit()
def _least_known(state: FilterState) -> float:
    """Turn ``doubted_b`` to where the bias is known least; return the variance along it.

    That is about the vertical, as the foot has stood so far: whoever gets up from a crawl
    has not shown what turned his heading while he crawled.  One step of the power iteration a
    sample follows it.
    """
    along = state.angle_rad  # as scratch
    square = 0.0
    for i in range(3):
        along[i] = _with_bias(state, GYRO_BIAS + i, state.doubted_b)
        square += along[i] * along[i]
    for i in range(3):
        state.doubted_b[i] = along[i] / math.sqrt(max(square, 1e-30))
    return _bias_variance(state, state.doubted_b)


@njit()
def _seen_bias_radps(state: FilterState) -> float:
    """Return the root mean square of the bias about the other two axes, which gravity shows.

    A sensor that is worse there than its kind is no better about the third.
    """
    square = 0.0
    doubted = 0.0
    for i in range(3):
        square += state.gyro_bias_radps[i] ** 2
        doubted += state.gyro_bias_radps[i] * state.doubted_b[i]
    return math.sqrt(max(0.5 * (square - doubted * doubted), 0.0))


@njit()
def believe_rest(state: FilterState, config: EskfConfig) -> None:
    """Widen the bias to what the first rest shows, where that is more than was to be expected.

    Everything the bias has moved is widened along with it, so that the stance corrects all of it.
    """
    if state.bias_shown:
        return
    off = state.angle_rad  # as scratch
    square = 0.0
    for i in range(3):
        off[i] = state.rest_rate_radps[i] - state.gyro_bias_radps[i]
        square += off[i] * off[i]
    expected = config.start_gyro_bias_gate * config.start_gyro_bias_std_radps
    # A foot that sways scatters by half of its mean rate at least.
    scattered = state.rest_rate_var_rad2ps2 > config.rest_rate_scatter**2 * square
    if scattered or square <= expected**2:
        return
    variance = _bias_variance(state, off) / square
    if variance >= square:
        return
    stated = max(state.unshown_bias_std_radps, config.start_gyro_bias_std_radps)
    if square > stated**2:
        for i in range(2):  # what is not linear was stated for one deviation
            state.bent_n_m[i] *= min(square / stated**2, BENT_MOST)
        state.unshown_bias_std_radps = math.sqrt(square)
    for i in range(SIZE):
        state.column[i] = _with_bias(state, i, off) / variance
    widen_past(state, off, 1.0 / variance)
    for i in range(SIZE):
        for j in range(SIZE):
            state.covariance[i, j] += state.column[i] * state.column[j]


@njit()
def is_bias_doubted(state: FilterState, config: EskfConfig) -> bool:
    """Whether more of the bias is doubted than the covariance says, and with it the heading."""
    beyond = state.unshown_bias_std_radps > config.start_gyro_bias_std_radps
    return bool(beyond and not state.bias_shown)


@njit()
def unshown_heading_variance(state: FilterState) -> float:
    return float(state.unshown[2] * state.unshown[2])


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
