"""Stance by the rate about the foot's pitch axis (Huang 2009, section 3.4).

The thesis fixes the axis by the mount; here it is the axis about which the foot has
turned most of late, so that any mount will do.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.tracker.huang.state import HuangConfig, HuangState
from edge.tracker.preprocessing.sample_ring import Ring, reach


@njit()
def follow_pitch_axis(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> None:
    """Advance the power iteration on the running spread of the rate by one step."""
    mask = len(ring) - 1
    rate = ring[k & mask].gyro_radps
    interval_s = ring[k & mask].t_s - ring[(k - 1) & mask].t_s if k else 0.0
    weight = min(interval_s / config.axis_memory_s, 1.0)
    axis = state.pitch_axis_b
    spread = state.rate_spread
    for i in range(3):
        for j in range(3):
            spread[i, j] += weight * (rate[i] * rate[j] - spread[i, j])
    x = (spread[0] * axis).sum()
    y = (spread[1] * axis).sum()
    z = (spread[2] * axis).sum()
    norm = np.sqrt(x * x + y * y + z * z)
    if norm > 1e-3:
        axis[0], axis[1], axis[2] = x / norm, y / norm, z / norm


@njit()
def is_stance(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> bool:
    """True when the pitch rate stays low around ``k`` for the minimum stance time."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    if ring[k & mask].motion_m2ps4 > config.stance_rate_radps:
        return _is_overdue(ring, state, k, config)
    first = k
    while first > 0 and ring[(first - 1) & mask].motion_m2ps4 <= config.stance_rate_radps:
        first -= 1
        if now_s - ring[first & mask].t_s >= config.least_stance_s:
            return True
    last = k
    stop = min(state.timed, reach(ring, k))
    while last + 1 < stop and pitch_rate(ring, state, last + 1) <= config.stance_rate_radps:
        last += 1
        if ring[last & mask].t_s - ring[first & mask].t_s >= config.least_stance_s:
            return True
    return k == 0


@njit()
def _is_overdue(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> bool:
    """After the longest swing the sample with the lowest rate ahead is taken for stance."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    if now_s - state.last_stance_s < config.longest_swing_s:
        return False
    for i in range(k + 1, min(state.timed, reach(ring, k))):
        if ring[i & mask].t_s - now_s > 0.5 * config.lookahead_s:
            break
        if pitch_rate(ring, state, i) < ring[k & mask].motion_m2ps4:
            return False
    return True


@njit()
def pitch_rate(ring: Ring, state: HuangState, k: int) -> float:
    return float(abs((ring[k & (len(ring) - 1)].gyro_radps * state.pitch_axis_b).sum()))
