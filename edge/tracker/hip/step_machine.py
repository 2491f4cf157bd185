"""Steps by a state machine (Hettiarachchige Don 2016, section 2.2.4, after Alzantot and Youssef).

The force has to pass four thresholds in order: it rises above the first (a step may begin), above
the positive peak, falls below the negative peak, and rises above the last one (the step ends).  The
thesis takes the acceleration along the walking direction; here it is the size of the force less
gravity, as in the original, which needs no mount, smoothed a little, as a telephone does it.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.hip.state import HipConfig, HipState
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.attitude import norm_of

_REST, _RISING, _HIGH, _FALLING, _LOW = range(5)


@njit()
def ends_step(ring: Ring, state: HipState, k: int, config: HipConfig) -> bool:
    """Take sample ``k``; True where a step ends with it."""
    mask = len(ring) - 1
    norm_mps2 = _smooth(ring, state, k, config.smooth_s)
    above_mps2 = norm_mps2 - state.trunk.rest_norm_mps2
    if state.phase == _REST:
        if above_mps2 <= config.start_mps2:
            return False
        _begin(state, k)
    _measure(state, norm_mps2, above_mps2)
    now_s = ring[k & mask].t_s
    if now_s - ring[state.began_at & mask].t_s > config.longest_period_s:
        state.phase = _REST
        return False
    if not _passes_all(state, above_mps2, config):
        return False
    if state.walking and now_s - state.step_s < config.least_period_s:
        state.passed_over += 1
        return False
    return True


@njit()
def _passes_all(state: HipState, above_mps2: float, config: HipConfig) -> bool:
    """Advance the phase by one sample; True where it has come round."""
    phase = state.phase
    if phase == _RISING and above_mps2 < 0.0:
        state.phase = _REST
    elif phase in (_RISING, _FALLING) and above_mps2 > config.positive_peak_mps2:
        state.phase = _HIGH
    elif phase == _HIGH and above_mps2 < config.positive_peak_mps2:
        state.phase = _FALLING
    elif phase == _FALLING and above_mps2 < config.negative_peak_mps2:
        state.phase = _LOW
    elif phase == _LOW and above_mps2 > config.end_mps2:
        state.phase = _REST
        return True
    return False


@njit()
def _smooth(ring: Ring, state: HipState, k: int, smooth_s: float) -> float:
    mask = len(ring) - 1
    norm_mps2 = norm_of(ring[k & mask].accel_mps2)
    if k == 0:
        state.smoothed_mps2 = norm_mps2
        return norm_mps2
    dt_s = max(ring[k & mask].t_s - ring[(k - 1) & mask].t_s, 0.0)
    state.smoothed_mps2 += (norm_mps2 - state.smoothed_mps2) * dt_s / (smooth_s + dt_s)
    return float(state.smoothed_mps2)


@njit()
def _begin(state: HipState, k: int) -> None:
    state.phase = _RISING
    state.began_at = k
    state.highest_mps2 = 0.0
    state.lowest_mps2 = 1e9
    state.sum_mps2 = state.swing_sum_mps2 = 0.0
    state.samples = 0


@njit()
def _measure(state: HipState, norm_mps2: float, above_mps2: float) -> None:
    state.highest_mps2 = max(state.highest_mps2, norm_mps2)
    state.lowest_mps2 = min(state.lowest_mps2, norm_mps2)
    state.sum_mps2 += norm_mps2
    state.swing_sum_mps2 += abs(above_mps2)
    state.samples += 1
