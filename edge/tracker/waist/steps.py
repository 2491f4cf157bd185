"""Steps by sliding window, peak and zero crossing (Li et al. 2014, sections 3.2 and 3.3).

The size of the specific force, whatever the sensor's axes, is averaged over a sliding window.  The
highest value between two crossings of its mean is a step where it is high enough and the step
before is long enough ago.  Its length is linear in the frequency of steps.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.attitude import norm_of
from edge.tracker.trunk.usual_steps import length_at
from edge.tracker.waist.state import WaistConfig, WaistState

NO_STEP = -1


@njit()
def find_step(ring: Ring, state: WaistState, k: int, config: WaistConfig) -> int:
    """Return the sample of a step's peak where ``k`` is its zero crossing, else ``NO_STEP``."""
    mask = len(ring) - 1
    smoothed_mps2 = _slide(ring, state, k, config.half_window_s)
    above_mps2 = smoothed_mps2 - state.trunk.rest_norm_mps2
    if above_mps2 > 0.0:
        if above_mps2 > state.peak_mps2:
            state.peak_mps2 = above_mps2
            state.peak_at = k
        return NO_STEP
    high_enough = state.peak_mps2 >= config.peak_mps2
    state.peak_mps2 = 0.0
    if not high_enough:
        return NO_STEP
    since_s = ring[state.peak_at & mask].t_s - state.step_s
    if state.walking and since_s < config.least_period_s:
        state.passed_over += 1
        return NO_STEP
    return int(state.peak_at)


@njit()
def _slide(ring: Ring, state: WaistState, k: int, half_s: float) -> float:
    """Return the mean size of the force within ``half_s`` of sample ``k``."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    while state.window_to < state.trunk.timed:
        entering = ring[state.window_to & mask]
        if entering.t_s - now_s > half_s:
            break
        state.window_sum_mps2 += norm_of(entering.accel_mps2)
        state.window_to += 1
    while now_s - ring[state.window_from & mask].t_s > half_s:
        state.window_sum_mps2 -= norm_of(ring[state.window_from & mask].accel_mps2)
        state.window_from += 1
    return float(state.window_sum_mps2 / (state.window_to - state.window_from))


@njit()
def step_length_m(period_s: float, config: WaistConfig) -> float:
    """Return the length of a step by its period: 0.4504 f - 0.1656, at the range's end beyond."""
    usual = config.usual
    return length_at(min(max(1.0 / period_s, usual.least_hz), usual.most_hz), usual)
