"""Steps: swings of the vertical velocity.

Every part of the trunk rises and sinks once a step, and so does what a hand holds; the velocity has
little of the heel strike's ringing and nothing of the sensor's own orientation.  A step is where it
begins to rise.  Two in a row make a walk: one alone may be sitting down.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import TICK_S, TICKS, BodyState, Ticks


@njit()
def begins_to_rise(ticks: Ticks, state: BodyState, config: BodyConfig) -> float:
    """Return the time within the last tick's interval at which a swing begins, or -1."""
    newest = state.ticks - 1
    here, before = ticks[newest & (TICKS - 1)], ticks[(newest - 1) & (TICKS - 1)]
    rise_mps = here.rise_mps
    state.rise_mps *= math.exp(-TICK_S / config.rise_memory_s)
    state.highest_mps = max(state.highest_mps, abs(rise_mps))
    least_mps = max(config.least_rise_mps, config.rise_share * state.rise_mps)
    if rise_mps < -least_mps:
        state.armed = True
    if newest == 0 or not state.armed or before.rise_mps > 0.0 or rise_mps <= 0.0:
        return -1.0
    t_s = here.t_s - TICK_S * rise_mps / (rise_mps - before.rise_mps)
    if t_s - state.event_s < config.shortest_step_s:
        return -1.0
    state.armed = False
    state.rise_mps += 0.3 * max(state.highest_mps - state.rise_mps, 0.0)
    state.highest_mps = 0.0
    return float(t_s)
