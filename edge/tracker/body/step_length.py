"""Step length: the trunk as an inverted pendulum (Zijlstra and Hof 1997).

On legs of length l a step of length L lifts the trunk by h = L^2 / (8 l).  A trunk that swings up
and down with deviation s of its acceleration and the duration T of a step moves by h ~ s T^2, so
L = c T sqrt(s); c has the leg in it and is fitted over people.  What a hand holds swings more up
and down than the trunk, and has a constant of its own; an arm that swings by itself throws it to
and fro as well, and the more of that there is, the less of s is the trunk's.  A thigh shows its
speed (``thigh_swing``).
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import TICKS, BodyState, Ticks
from edge.tracker.body.thigh_swing import leg_speed

LONGEST_M = 1.8


@njit()
def step_length(
    ticks: Ticks, state: BodyState, from_s: float, to_s: float, config: BodyConfig
) -> float:
    """Return the length of the step between two times, before the person's own scale."""
    count = 0
    total = squares = level_squares = last_rad = 0.0
    k = state.ticks - 1
    while k >= 0 and state.ticks - k < TICKS:
        tick = ticks[k & (TICKS - 1)]
        if tick.t_s < from_s:
            break
        if tick.t_s <= to_s:
            count += 1
            last_rad = tick.heading_rad if count == 1 else last_rad
            total += tick.up_mps2
            squares += tick.up_mps2**2
            level_squares += tick.north_mps2**2 + tick.east_mps2**2
        k -= 1
    if count < 2:
        return 0.0
    deviation_mps2 = math.sqrt(max(squares / count - (total / count) ** 2, 0.0))
    constant = config.trunk_scale_m
    if state.in_hand:
        constant = config.hand_scale_m
        deviation_mps2 /= 1.0 + level_squares / count / config.hand_swing_mps2**2
    length_m = constant * (to_s - from_s) * math.sqrt(deviation_mps2)
    if state.in_pocket:
        length_m = leg_speed(ticks, state, from_s, to_s, config) * (to_s - from_s)
    return float(min(length_m / (1.0 + _turning(state, last_rad, to_s, config)), LONGEST_M))


@njit()
def _turning(state: BodyState, now_rad: float, now_s: float, config: BodyConfig) -> float:
    """Return the square of the turn rate over a stride, as the pelvis swings about in each step.

    A turn on the spot lifts the trunk, too, without a distance.
    """
    since_s = now_s - state.turned_s[0]
    rate_radps = (now_rad - state.turned_rad[0]) / max(since_s, config.shortest_step_s)
    for times in (state.turned_s, state.turned_rad):
        times[0] = times[1]
    state.turned_s[1], state.turned_rad[1] = now_s, now_rad
    return float((rate_radps / config.pivot_radps) ** 2)
