"""Turn that clipped rates hide in every swing alike: reported, not filtered.

What a scaled parabola misses of the hidden peak of a rate (see saturation_recovery) is noise to the
filter, new in every swing.  But a foot swings alike in every stride, and so does a part of what is
missed: its turns add up one to one and not by their squares, and turn the walk.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import FilterState


@njit()
def add_hidden_turn(state: FilterState, config: EskfConfig) -> None:
    """Add, at a footfall, what the swing before it may have hidden of the turn of every swing."""
    state.hidden_turn_rad += config.clipping.hidden_turn_share * math.sqrt(state.swing_hidden_rad2)
    state.swing_hidden_rad2 = 0.0


@njit()
def propagate_hidden_turn(state: FilterState, dt_s: float) -> None:
    """Add the way of an interval times the turn so far, across the way."""
    state.hidden_way_n_m[0] -= state.hidden_turn_rad * dt_s * state.velocity_n_mps[1]
    state.hidden_way_n_m[1] += state.hidden_turn_rad * dt_s * state.velocity_n_mps[0]
