"""Doubt of steps that are not those of a usual walk: a run, a dragged foot, stairs.

The error is the same from step to step while such a gait lasts, and grows with the way; that of
another time is another one.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import NORTH, BodyState
from edge.tracker.trunk.usual_steps import is_usual, length_doubt_m


@njit()
def step_doubt_m(state: BodyState, step_s: float, length_m: float, config: BodyConfig) -> float:
    """Return the deviation of the length of the step that ends now; 0 for a usual one.

    By its stride, as the two steps of one are not alike.
    """
    heights_m = state.ended_down_m
    steps, lasted_s = 2, step_s + state.last_step_s
    if state.swings == 0:
        steps, lasted_s = 1, step_s
        heights_m[:] = state.down_m
    climbed_m = heights_m[0] - state.down_m
    heights_m[0], heights_m[1] = heights_m[1], state.down_m
    state.last_step_s = step_s
    if is_usual(steps, lasted_s, climbed_m, config.usual):
        return 0.0
    return float(length_doubt_m(steps, lasted_s, steps * length_m, config.usual) / steps)


@njit()
def take_doubt(state: BodyState, doubt_m: float, heading_rad: float) -> None:
    """Carry the doubt over one step; a usual one ends what has added up."""
    unusual_m = state.unusual_m
    if doubt_m > 0.0:
        unusual_m[0] += doubt_m * math.cos(heading_rad)
        unusual_m[1] += doubt_m * math.sin(heading_rad)
        return
    for i in range(2):
        for j in range(2):
            state.covariance[NORTH + i, NORTH + j] += unusual_m[i] * unusual_m[j]
    unusual_m[:] = 0.0
