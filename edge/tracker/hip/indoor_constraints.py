"""Constraints of a building with straight corridors and right angles (section 3.3.1).

They are off by default: on open ground, or where corridors bend, they turn a right
path into a wrong one.  Headings are those of two steps, in which the twist of the hip cancels out.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.hip.error_state import propagate, update
from edge.tracker.hip.state import HipConfig, HipState
from edge.tracker.mechanization.quasi_static import turn_heading
from edge.tracker.mechanization.strapdown import rotation_matrix

_NO_CHANGE = math.nan


@njit()
def constrain_heading(
    state: HipState, forward_n: Floats, t_s: float, period_s: float, config: HipConfig
) -> None:
    """Take the heading of the step that ends now; turn the attitude where a constraint holds."""
    propagate(state.turn_cov, period_s, config.turn_noise_rad2ps, config.turn_bias_noise_rad2ps3)
    heading_rad = math.atan2(forward_n[1], forward_n[0])
    turned_rad = _wrapped(heading_rad - state.heading_rad)
    now_rad = state.heading_rad + turned_rad
    of_two_rad = 0.5 * (now_rad + state.heading_rad)
    rate_radps = (of_two_rad - 0.5 * (state.heading_rad + state.before_rad)) / period_s
    state.before_rad, state.heading_rad = state.heading_rad, now_rad
    off_rad = _off_rad(state, of_two_rad, rate_radps, t_s, config)
    if math.isnan(off_rad):
        return
    error = np.zeros(2)
    update(state.turn_cov, 0, off_rad, config.constraint_std_rad**2, error)
    _turn(state, error)


@njit()
def end_straight_way(state: HipState, t_s: float) -> None:
    """Remember the way that ends with a turn, or with a halt."""
    if state.straight:
        state.corridor_rad = state.straight_rad
        state.has_corridor = True
    state.straight = False
    state.straight_from_s = t_s


@njit()
def _off_rad(
    state: HipState, heading_rad: float, rate_radps: float, t_s: float, config: HipConfig
) -> float:
    """Return by how much a constraint would turn the heading; NaN where none holds."""
    if abs(rate_radps) > config.straight_radps:
        end_straight_way(state, t_s)
        return _NO_CHANGE
    if t_s - state.straight_from_s < config.straight_s:
        return _NO_CHANGE
    if not state.straight:
        state.straight = True
        state.straight_rad = heading_rad
        state.held = config.straight_walks
        if config.right_angles and state.has_corridor:
            _square(state, config)
    return state.straight_rad - heading_rad if state.held else _NO_CHANGE


@njit()
def _square(state: HipState, config: HipConfig) -> None:
    """Put this straight way at a right angle to the one before, if it is nearly so."""
    right_rad = 0.5 * math.pi
    quarters = round((state.straight_rad - state.corridor_rad) / right_rad)
    square_rad = state.corridor_rad + quarters * right_rad
    if abs(square_rad - state.straight_rad) <= config.corner_rad:
        state.straight_rad = square_rad
        state.held = True


@njit()
def _turn(state: HipState, error: Floats) -> None:
    """Turn attitude, headings and the bias about the vertical by ``error`` (2,), rad and rad/s."""
    trunk = state.trunk
    turn_heading(trunk.quaternion_nb, error[0])
    for i in range(3):
        trunk.gyro_bias_radps[i] -= error[1] * trunk.rotation_nb[2, i]
    rotation_matrix(trunk.quaternion_nb, trunk.rotation_nb)
    state.heading_rad += error[0]
    state.before_rad += error[0]


@njit()
def _wrapped(angle_rad: float) -> float:
    return math.atan2(math.sin(angle_rad), math.cos(angle_rad))
