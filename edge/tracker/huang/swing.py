"""Swing of the thesis's tracker: integrated, and integrated again without its drift.

Velocity and orientation are reset in stance (Huang 2009, 3.6); what is left of velocity and angle
at the end of a swing is removed from it as if constant biases had caused it (3.7).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.huang.state import HuangConfig, HuangState
from edge.tracker.mechanization.quasi_static import static_orientation, turn_heading
from edge.tracker.mechanization.strapdown import advance, rotation_matrix
from edge.tracker.preprocessing.sample_ring import Ring, history

MIN_STRIDE_M = 0.15


@njit()
def step(
    ring: Ring,
    state: HuangState,
    k: int,
    still: bool,
    gyro_bias_radps: Floats,
    drift_n_mps2: Floats,
    config: HuangConfig,
) -> None:
    """Strapdown (2.17, 2.20 to 2.24) to sample ``k`` without two biases; a still foot stays."""
    if k == 0:
        return
    mask = len(ring) - 1
    here, before = ring[k & mask], ring[(k - 1) & mask]
    dt_s = here.t_s - before.t_s
    if dt_s <= 0.0 or dt_s > config.gap_s:
        return
    held_n_m = state.position_n_m.copy()
    advance(
        state.position_n_m,
        state.velocity_n_mps,
        state.quaternion_nb,
        state.rotation_nb,
        0.5 * (here.accel_mps2 + before.accel_mps2),
        0.5 * (here.gyro_radps + before.gyro_radps) - gyro_bias_radps,
        config.gravity_mps2,
        dt_s,
        np.zeros(3),
        np.zeros(3),
    )
    for i in range(3):
        if still:
            state.position_n_m[i] = held_n_m[i]
            state.velocity_n_mps[i] = 0.0
        else:
            state.position_n_m[i] -= 0.5 * drift_n_mps2[i] * dt_s * dt_s
            state.velocity_n_mps[i] -= drift_n_mps2[i] * dt_s


@njit()
def remove_swing_drift(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> None:
    """Reset in the middle of a stance (3.6), and go over the swing again (3.7).

    In the middle the low-passed acceleration sees as much of the braking before as of
    the pushing off after, and they cancel.
    """
    mask = len(ring) - 1
    since_s = ring[k & mask].t_s - ring[state.reset_at & mask].t_s
    tracked = state.quaternion_nb.copy()
    static_orientation(ring, state.timed, k, config.low_pass_s, state.declination_rad, state)
    static = state.quaternion_nb.copy()
    swung = not state.settled and state.stance_from > state.swing_from >= state.reset_at
    if swung and since_s > 0.0 and k - state.reset_at <= history(ring):
        bias_radps = _turn_between(static, tracked) / since_s
        still = np.zeros(3)
        drift_mps = _replay(ring, state, k, bias_radps, still, config)
        swing_s = ring[state.stance_from & mask].t_s - ring[state.swing_from & mask].t_s
        _replay(ring, state, k, bias_radps, drift_mps / swing_s, config)
        _count_stride(state)
    for i in range(4):
        state.quaternion_nb[i] = static[i]
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    mark_reset(state, k)
    state.settled = True


@njit()
def _replay(
    ring: Ring,
    state: HuangState,
    last: int,
    gyro_bias_radps: Floats,
    drift_n_mps2: Floats,
    config: HuangConfig,
) -> Floats:
    """Walk again from the last reset to ``last``; return the velocity when the foot came down.

    Rows that are not released yet are written again.
    """
    for i in range(3):
        state.position_n_m[i] = state.reset_position_n_m[i]
        state.velocity_n_mps[i] = 0.0
    for i in range(4):
        state.quaternion_nb[i] = state.reset_quaternion_nb[i]
    down_n_mps = np.zeros(3)
    for k in range(state.reset_at + 1, last + 1):
        still = not state.swing_from < k <= state.stance_from
        step(ring, state, k, still, gyro_bias_radps, drift_n_mps2, config)
        if k == state.stance_from:
            for i in range(3):
                down_n_mps[i] = state.velocity_n_mps[i]
        if k >= state.released:
            keep_row(ring, state, k)
    for i in range(3):
        state.velocity_n_mps[i] = 0.0
    return down_n_mps


@njit()
def turn_to_true_north(state: HuangState) -> None:
    """Take the declination that was learned; it is no drift of the swing it comes in."""
    turn_rad = state.learned_rad - state.declination_rad
    state.declination_rad = state.learned_rad
    turn_heading(state.quaternion_nb, turn_rad)
    turn_heading(state.reset_quaternion_nb, turn_rad)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    north_mps, east_mps = state.velocity_n_mps[0], state.velocity_n_mps[1]
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    state.velocity_n_mps[0] = cosine * north_mps - sine * east_mps
    state.velocity_n_mps[1] = sine * north_mps + cosine * east_mps


@njit()
def mark_reset(state: HuangState, k: int) -> None:
    state.reset_at = k
    for i in range(3):
        state.reset_position_n_m[i] = state.position_n_m[i]
    for i in range(4):
        state.reset_quaternion_nb[i] = state.quaternion_nb[i]


@njit()
def _turn_between(quaternion_nb: Floats, tracked_nb: Floats) -> Floats:
    """Return the rotation vector (3,), sensor axes, from an attitude to a tracked one."""
    a = quaternion_nb
    b = tracked_nb
    w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    side = 2.0 if w >= 0.0 else -2.0
    return np.array(
        [
            side * (a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2]),
            side * (a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1]),
            side * (a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]),
        ]
    )


@njit()
def _count_stride(state: HuangState) -> None:
    north_m = state.position_n_m[0] - state.foothold_n_m[0]
    east_m = state.position_n_m[1] - state.foothold_n_m[1]
    moved_m = np.sqrt(north_m * north_m + east_m * east_m)
    if moved_m > MIN_STRIDE_M:
        state.steps += 1
        state.distance_m += moved_m
        for i in range(3):
            state.foothold_n_m[i] = state.position_n_m[i]


@njit()
def keep_row(ring: Ring, state: HuangState, k: int) -> None:
    """Put position, velocity and attitude into the row of ``k``."""
    row = ring[k & (len(ring) - 1)]
    for i in range(3):
        row.position_n_m[i] = state.position_n_m[i]
        row.velocity_n_mps[i] = state.velocity_n_mps[i]
    for i in range(4):
        row.quaternion_nb[i] = state.quaternion_nb[i]
