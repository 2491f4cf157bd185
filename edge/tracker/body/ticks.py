"""Motion at regular ticks, whatever the rate of the sensor.

Three one-pole low passes follow each other (-3 dB at 4 Hz); their output is interpolated at every
20 ms, so that what follows costs the same at any rate.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import TICK_S, TICKS, BodyState, Ticks


@njit()
def low_pass(state: BodyState, dt_s: float, config: BodyConfig) -> None:
    """Take the force of a sample."""
    share = 1.0 - math.exp(-dt_s / config.low_pass_s)
    force, stages = state.force_n_mps2, state.low_pass_n_mps2
    for i in range(3):
        value = force[i] if i < 2 else -force[2] - config.gravity_mps2
        state.before_n_mps2[i] = stages[2, i]
        for stage in range(3):
            stages[stage, i] += share * (value - stages[stage, i])
            value = stages[stage, i]


@njit()
def next_tick(
    ticks: Ticks, state: BodyState, before_s: float, now_s: float, config: BodyConfig
) -> bool:
    """Write the next tick up to ``now_s``; false when there is none."""
    tick_s = state.ticks * TICK_S
    if tick_s > now_s:
        return False
    share = (
        1.0 if now_s <= before_s else min(max((tick_s - before_s) / (now_s - before_s), 0.0), 1.0)
    )
    tick = ticks[state.ticks & (TICKS - 1)]
    before, here = state.before_n_mps2, state.low_pass_n_mps2[2]
    tick.t_s = tick_s
    tick.north_mps2 = before[0] + share * (here[0] - before[0])
    tick.east_mps2 = before[1] + share * (here[1] - before[1])
    tick.up_mps2 = before[2] + share * (here[2] - before[2])
    tick.heading_rad = state.before_rad + share * (state.heading_rad - state.before_rad)
    tick.swing_radps = state.sample_swing_radps
    tick.rise_mps = _rise(state, tick.up_mps2, config)
    state.ticks += 1
    return True


@njit()
def _rise(state: BodyState, up_mps2: float, config: BodyConfig) -> float:
    """Return the vertical velocity by a leaky integral, less its slow mean."""
    leak = 1.0 - math.exp(-TICK_S / config.leak_s)
    state.leaked_mps += TICK_S * up_mps2 - leak * state.leaked_mps
    state.mean_mps += 0.5 * leak * (state.leaked_mps - state.mean_mps)
    return float(state.leaked_mps - state.mean_mps)
