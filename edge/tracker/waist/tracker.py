"""Tracker by the method of Li et al. (2014): steps of a sensor on the waist.

Steps and their lengths by the acceleration (``steps``), heading by a complementary filter, height
by air pressure (both in ``edge.tracker.trunk``); the position moves step by step.  Any mount will
do; the path's frame is turned by where the sensor faces on its wearer.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats, SensorDescription
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.dead_reckoning import (
    begin_walk,
    mean_forward,
    place_row,
    release_standing,
    take_step,
    write_rows,
)
from edge.tracker.trunk.follow import follow_sample
from edge.tracker.trunk.kernel_tracker import KernelTracker, is_past, new_states, take_times
from edge.tracker.trunk.usual_steps import is_usual, length_std
from edge.tracker.waist.state import WAIST, WaistConfig, WaistState
from edge.tracker.waist.steps import NO_STEP, find_step, step_length_m


class WaistTracker(KernelTracker):
    """Step detection, step length by frequency, heading and height; see ``Tracker``."""

    def __init__(self, description: SensorDescription, config: WaistConfig | None = None) -> None:
        super().__init__(description, new_states(WAIST), walk, config or WaistConfig())


@njit(cache=True)
def walk(ring: Ring, states: NDArray[Any], config: WaistConfig, final: bool) -> int:
    """Take every sample as far as it can go; return one past the last released row."""
    state = states[0]
    trunk = state.trunk
    take_times(ring, trunk, config.trunk, final)
    angle_b_rad, forward_n, from_n_m = np.zeros(3), np.zeros(2), np.zeros(3)
    while trunk.walked < trunk.timed:
        k = trunk.walked
        if not final and not is_past(ring, trunk, k, config.trunk.lookahead_s):
            break
        follow_sample(ring, trunk, k, angle_b_rad, config.trunk)
        trunk.walked = k + 1
        peak_at = find_step(ring, state, k, config)
        if peak_at != NO_STEP:
            _step(ring, state, peak_at, forward_n, from_n_m, config)
        release_standing(ring, trunk, k, config.trunk)
    if final:
        trunk.released = trunk.walked
    return int(trunk.released)


@njit()
def _step(
    ring: Ring,
    state: WaistState,
    peak_at: int,
    forward_n: Floats,
    from_n_m: Floats,
    config: WaistConfig,
) -> None:
    """Take the step with its peak at ``peak_at``, and write and release the rows up to there.

    The first step of a walk has no period yet: it is as long as the slowest, and what it was longer
    than that comes with the second, whose period it is taken to have had.
    """
    mask = len(ring) - 1
    trunk = state.trunk
    t_s = ring[peak_at & mask].t_s
    period_s = t_s - state.step_s
    state.walking = state.walking and period_s <= config.longest_period_s
    if state.walking:
        length_m = step_length_m(period_s, config)
        length_m += max(length_m - state.first_m, 0.0) if state.first_m > 0.0 else 0.0
        state.first_m = 0.0
        begin = state.step_at + 1
    else:
        period_s = 1.0 / config.usual.least_hz
        length_m = state.first_m = step_length_m(period_s, config)
        begin_walk(trunk, config.trunk)
        begin = min(trunk.released, peak_at)
        while t_s - ring[begin & mask].t_s > period_s:
            begin += 1
    first = max(begin, trunk.released)
    for i in range(3):
        from_n_m[i] = trunk.position_n_m[i]
    from_distance_m = trunk.distance_m
    mean_forward(ring, trunk, begin, peak_at, forward_n)
    rise_m = trunk.height_m - state.step_height_m
    std, steps = config.trunk.length_std, 1 + state.passed_over
    if not is_usual(steps, period_s, rise_m, config.usual):
        std = length_std(steps, period_s, length_m, std, config.usual)
    state.passed_over = 0
    take_step(trunk, length_m, std, forward_n, t_s, config.trunk)
    write_rows(ring, trunk, first, peak_at, from_n_m, from_distance_m, config.trunk)
    for k in range(peak_at + 1, trunk.walked):
        place_row(ring, trunk, k, config.trunk)
    trunk.released = max(trunk.released, peak_at + 1)
    state.step_at = peak_at
    state.step_s = t_s
    state.step_height_m = trunk.height_m
    state.walking = True
