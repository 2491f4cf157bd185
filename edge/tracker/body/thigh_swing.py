"""Thigh swing: a sensor in a trouser pocket turns with the leg.

While its foot stands the leg is a rod that turns about the sole: its rate about level axes times
its length is the speed of the hip.  A foot stands for more than half of a stride, at an even rate,
and the swing is much faster, so the median over a stride is the rate of the stance.  Nothing
else that a walking person carries turns as fast about level axes.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.tracker.body.config import POCKET, UNKNOWN_PLACE, BodyConfig
from edge.tracker.body.state import TICKS, BodyState, Sample, Ticks


@njit()
def swing_rate(state: BodyState, sample: Sample) -> float:
    """Return the rate of a sample about level axes, rad/s."""
    square = 0.0
    for i in range(2):
        row, rate = state.rotation_nb[i], 0.0
        for j in range(3):
            rate += row[j] * (sample.gyro_radps[j] - state.gyro_bias_radps[j])
        square += rate * rate
    return float(math.sqrt(square))


@njit()
def recognise_thigh(
    ticks: Ticks, state: BodyState, from_s: float, to_s: float, config: BodyConfig
) -> None:
    """Take the mean rate of one step: a thigh turns faster than a trunk or a hand."""
    if config.place != UNKNOWN_PLACE:
        state.in_pocket = config.place == POCKET
        return
    rates, count = state.swing_rates_radps, _rates_between(ticks, state, from_s, to_s)
    share = 1.0 / min(state.direction_weight + 1.0, config.direction_steps)
    state.swing_radps += share * (rates[:count].sum() / max(count, 1) - state.swing_radps)
    if state.swing_radps > config.thigh_above_radps:
        state.in_pocket = state.direction_weight >= config.recognised_steps
    elif state.swing_radps < config.thigh_below_radps:
        state.in_pocket = False


@njit()
def leg_speed(
    ticks: Ticks, state: BodyState, from_s: float, to_s: float, config: BodyConfig
) -> float:
    """Return the speed of the hip over the stride whose second step lies between two times, m/s."""
    count = _rates_between(ticks, state, 2.0 * from_s - to_s, to_s)
    if count == 0:
        return 0.0
    return float(config.leg_m * np.median(state.swing_rates_radps[:count]))


@njit()
def _rates_between(ticks: Ticks, state: BodyState, from_s: float, to_s: float) -> int:
    """Copy the rates of the ticks between two times, newest first; return how many."""
    count, k = 0, state.ticks - 1
    while k >= 0 and state.ticks - k < TICKS:
        tick = ticks[k & (TICKS - 1)]
        if tick.t_s < from_s:
            break
        if tick.t_s <= to_s:
            state.swing_rates_radps[count] = tick.swing_radps
            count += 1
        k -= 1
    return count
