"""Turn that gaps hide: reported until a compass shows the heading, though the filter forgets it.

A walk turned as a whole looks the same to every stance, so no stance can tell how far the foot has
turned in a gap, but for the first one after it, where the foot was swinging meanwhile.  The filter
believes that each does: by first order a heading error turns the velocity that a stance takes away,
and that is not zero (the false observability of Huang, Mourikis and Roumeliotis, "Observability-
based rules for designing consistent EKF SLAM estimators", 2010).  To a heading that is known well
that matters little.  Of the doubt that a gap has left, a third is gone in half a minute.

So what gaps have added to the variance of the heading is counted here, and what the filter has
forgotten of it is reported beside its own, with the way that it turns: one error, alike in sign.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.error_state import ATTITUDE
from edge.tracker.foot.state import FilterState

YAW = ATTITUDE + 2


@njit()
def add_gap_turn(state: FilterState, variance_rad2: float) -> None:
    """Add what a gap has added to the variance of the heading."""
    state.gap_turn_rad2 += variance_rad2
    state.gap_turn_is_new = True


@njit()
def learn_gap_turn(state: FilterState) -> None:
    """Take over what the filter knows of the turn: by a compass, or by the stance after the gap."""
    state.gap_turn_rad2 = min(state.gap_turn_rad2, state.covariance[YAW, YAW])
    state.gap_turn_is_new = False


@njit()
def forgotten_turn_variance(state: FilterState) -> float:
    """Return what the filter has forgotten of the variance (rad^2) that gaps have left."""
    return float(max(state.gap_turn_rad2 - state.covariance[YAW, YAW], 0.0))


@njit()
def propagate_gap_turn(state: FilterState, dt_s: float) -> None:
    """Add the way of an interval times one deviation of the forgotten turn, across the way."""
    turn_rad = math.sqrt(forgotten_turn_variance(state))
    state.gap_way_n_m[0] -= turn_rad * dt_s * state.velocity_n_mps[1]
    state.gap_way_n_m[1] += turn_rad * dt_s * state.velocity_n_mps[0]
