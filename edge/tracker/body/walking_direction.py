"""Walking direction against the sensor's own, from the phase of its motion.

A trunk is fastest where it is lowest: horizontal acceleration in phase with the downward velocity
points forward.  Side to side it swings at half the frequency, which cancels out.  What a hand holds
tips forward as it is thrown up, so that its part in phase with the upward acceleration points
forward too; in a trunk that part is small.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.body.config import UNKNOWN_PLACE, BodyConfig
from edge.tracker.body.state import TICKS, BodyState, Ticks


@njit()
def take_direction(
    ticks: Ticks, state: BodyState, from_s: float, to_s: float, config: BodyConfig
) -> None:
    """Take the motion of one step: its direction, and whether a hand holds the sensor."""
    per_s = 2.0 * math.pi / (to_s - from_s)
    sums, fall_square, up_square = state.phase_sums, 0.0, 0.0
    for i in range(4):
        sums[i] = 0.0
    mean_mps2 = _mean_up(ticks, state, from_s, to_s)
    k = state.ticks - 1
    while k >= 0 and state.ticks - k < TICKS:
        tick = ticks[k & (TICKS - 1)]
        if tick.t_s < from_s:
            break
        if tick.t_s <= to_s:
            cosine, sine = math.cos(tick.heading_rad), math.sin(tick.heading_rad)
            along = cosine * tick.north_mps2 + sine * tick.east_mps2
            across = cosine * tick.east_mps2 - sine * tick.north_mps2
            fall_mps2, up_mps2 = -per_s * tick.rise_mps, tick.up_mps2 - mean_mps2
            sums[0] += fall_mps2 * along
            sums[1] += fall_mps2 * across
            sums[2] += up_mps2 * along
            sums[3] += up_mps2 * across
            fall_square += fall_mps2 * fall_mps2
            up_square += up_mps2 * up_mps2
        k -= 1
    if fall_square <= 0.0 or up_square <= 0.0:
        return
    state.direction_weight = min(state.direction_weight + 1.0, config.direction_steps)
    slow = 1.0 / state.direction_weight
    for i in range(2):
        falling, rising = sums[i] / fall_square, sums[2 + i] / up_square
        state.falling[i] += slow * (falling - state.falling[i])
        state.direction[i] += slow * (falling + rising - state.direction[i])
    _recognise_hand(state, config)


@njit()
def _mean_up(ticks: Ticks, state: BodyState, from_s: float, to_s: float) -> float:
    total, count = 0.0, 0
    k = state.ticks - 1
    while k >= 0 and state.ticks - k < TICKS:
        tick = ticks[k & (TICKS - 1)]
        if tick.t_s < from_s:
            break
        if tick.t_s <= to_s:
            total += tick.up_mps2
            count += 1
        k -= 1
    return total / max(count, 1)


@njit()
def _recognise_hand(state: BodyState, config: BodyConfig) -> None:
    """A forearm damps the swing to and fro, and tips what it throws up."""
    if config.place != UNKNOWN_PLACE or state.direction_weight < config.recognised_steps:
        return
    falling = _length(state.falling)
    north, east = (
        state.direction[0] - state.falling[0],
        state.direction[1] - state.falling[1],
    )
    tipping = math.sqrt(north * north + east * east)
    if falling < config.hand_below and tipping > config.hand_tips:
        state.in_hand = True
    elif falling > config.trunk_above or tipping < config.trunk_tips * falling:
        state.in_hand = False


@njit()
def _length(vector: Floats) -> float:
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1])


@njit()
def direction_rad(state: BodyState) -> float:
    """Return the walk's direction from the sensor's heading, clockwise; 0 while unknown."""
    return math.atan2(state.direction[1], state.direction[0])
