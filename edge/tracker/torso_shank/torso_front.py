"""Front of the torso, by what pushes it when its speed changes.

The axis that the path takes for the front is only the sensor's most level one.  A start, a turn or
a stop accelerates along the true direction: the integral of the acceleration over a stride and the
change of velocity by shank and heading differ by the angle between the two.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.torso_shank.state import StrideState, TorsoShankConfig
from edge.tracker.trunk.attitude import level_force


@njit()
def update_front_direction(state: StrideState, end_n_mps: Floats, config: TorsoShankConfig) -> None:
    """Update the direction of the front by the stride that ends with a velocity (2,) in m/s."""
    north_mps = end_n_mps[0] - state.begin_n_mps[0]
    east_mps = end_n_mps[1] - state.begin_n_mps[1]
    pushed = state.pushed_n_mps
    kept = 1.0 - 1.0 / config.front_memory
    state.front[0] = kept * state.front[0] + north_mps * pushed[0] + east_mps * pushed[1]
    state.front[1] = kept * state.front[1] + north_mps * pushed[1] - east_mps * pushed[0]
    state.front_m2ps2 = kept * state.front_m2ps2 + north_mps**2 + east_mps**2


@njit()
def add_push(
    ring: Ring, state: StrideState, k: int, dt_s: float, force_n: Floats, config: TorsoShankConfig
) -> None:
    """Add the level acceleration of sample ``k`` to that of its stride.

    What is left in ``force_n`` (2,) is turned as the path is, and zero while the front is unknown.
    """
    level_force(ring[k & (len(ring) - 1)], force_n)
    for i in range(2):
        state.pushed_n_mps[i] += dt_s * force_n[i]
    size = math.sqrt(state.front[0] ** 2 + state.front[1] ** 2)
    if size < config.front_m2ps2 or size < config.front_agreement * state.front_m2ps2:
        force_n[0] = force_n[1] = 0.0
        return
    cos, sin = state.front[0] / size, state.front[1] / size
    north = cos * force_n[0] + sin * force_n[1]
    force_n[1] = cos * force_n[1] - sin * force_n[0]
    force_n[0] = north
