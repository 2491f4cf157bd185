"""Steps of the torso, by the method of ``waist``, for where the shank shows no strides.

While it does, they are counted beside its strides, so that their lengths are learnt.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.torso_shank.state import StrideState, TorsoShankConfig
from edge.tracker.trunk.dead_reckoning import mean_forward, place_row, take_step, write_rows
from edge.tracker.waist.steps import NO_STEP, find_step, step_length_m


@njit()
def follow_steps(ring: Ring, state: StrideState, k: int, config: TorsoShankConfig) -> None:
    """Take sample ``k`` into the detector; a step moves the torso where they count."""
    mask = len(ring) - 1
    waist = state.waist
    peak_at = find_step(ring, waist, k, config.waist)
    if peak_at == NO_STEP:
        return
    t_s = ring[peak_at & mask].t_s
    period_s = t_s - waist.step_s
    waist.walking = waist.walking and period_s <= config.waist.longest_period_s
    if not waist.walking:
        period_s = 1.0 / config.waist.usual.least_hz
    length_m = _learnt_ratio(state) * step_length_m(period_s, config.waist)
    state.steps_since_m += length_m
    if state.steps_since == 0:
        state.first_step_s = t_s
    state.steps_since += 1
    waist.step_s, waist.walking = t_s, True
    if state.by_steps and peak_at > state.counted_at:
        # Of a step that began before the steps counted, only what came then.
        since_s = t_s - ring[state.counted_at & mask].t_s
        advance_path(ring, state, peak_at, length_m * min(since_s / period_s, 1.0), config)


@njit()
def advance_path(
    ring: Ring, state: StrideState, at: int, length_m: float, config: TorsoShankConfig
) -> None:
    """Go a way up to sample ``at``, from where the way was counted to."""
    trunk = state.waist.trunk
    forward_n, from_n_m = np.zeros(2), np.zeros(2)
    first = max(state.counted_at + 1, trunk.released)
    mean_forward(ring, trunk, state.counted_at + 1, at, forward_n)
    from_n_m[0], from_n_m[1] = trunk.position_n_m[0], trunk.position_n_m[1]
    from_distance_m = trunk.distance_m
    std = state.leg_std if state.steps_m > 0.0 else config.trunk.length_std
    t_s = ring[at & (len(ring) - 1)].t_s
    take_step(trunk, length_m, std, forward_n, t_s, config.trunk)
    trunk.random_m2 += (config.learnt_step_std * length_m) ** 2
    write_rows(ring, trunk, first, at, from_n_m, from_distance_m, config.trunk)
    for k in range(at + 1, trunk.walked):
        place_row(ring, trunk, k, config.trunk)
    state.counted_at = at


@njit()
def _learnt_ratio(state: StrideState) -> float:
    return state.strides_m / state.steps_m if state.steps_m > 0.0 else 1.0
