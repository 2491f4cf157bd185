"""Attitude from gyroscope and gravity, and the gyroscope's bias from who stands.

A complementary filter (Mahony et al. 2008) whose correction lies in the horizontal plane: the
heading is the gyroscope's alone, so that what the path filter finds of its error is no part of it.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.path_filter import update_bias_at_rest
from edge.tracker.body.state import HEADING, TICK_S, BodyState, Sample
from edge.tracker.mechanization.quasi_static import turn_upright
from edge.tracker.mechanization.strapdown import rotate_attitude, rotate_navigation, rotation_matrix
from edge.tracker.preprocessing.sample_ring import Ring

_LOST_TURN_RAD = 0.35  # of a gap as long as a turn takes
_REFERENCE_COSINE = 0.5  # tilted farther from it than by 60 degrees, a new one is taken


@njit()
def step_attitude(ring: Ring, state: BodyState, k: int, config: BodyConfig) -> float:
    """Bring attitude, heading and force to sample ``k``; return the time since the one before."""
    mask = len(ring) - 1
    here, before = ring[k & mask], ring[(k - 1) & mask]
    if k == 0:
        turn_upright(state.quaternion_nb, here.accel_mps2)
        rotation_matrix(state.quaternion_nb, state.rotation_nb)
        state.reference_nb[:] = state.rotation_nb
        _turn_force(here, state)
        return 0.0
    dt_s = here.t_s - before.t_s
    if dt_s > config.gap_s:
        _bridge_gap(state, dt_s)
    elif dt_s > 0.0:
        for i in range(3):
            rate = 0.5 * (here.gyro_radps[i] + before.gyro_radps[i]) - state.gyro_bias_radps[i]
            state.angle_b_rad[i] = rate * dt_s
        rotate_attitude(state.quaternion_nb, state.angle_b_rad)
        rotation_matrix(state.quaternion_nb, state.rotation_nb)
        _follow_heading(state)
        _turn_force(here, state)
        _level(state, dt_s, config)
        state.settled_s += dt_s
    else:
        _turn_force(here, state)
    return float(max(dt_s, 0.0))


@njit()
def _follow_heading(state: BodyState) -> None:
    """Bring the heading to the attitude's turn about the vertical since a reference.

    The rate about the vertical does not add up to it: a thigh that swings and leans describes a
    cone, and each stride adds the angle that this cone encloses.
    """
    here, there = state.rotation_nb, state.reference_nb
    sine = cosine = upright = 0.0
    for j in range(3):
        sine += here[1, j] * there[0, j] - here[0, j] * there[1, j]
        cosine += here[0, j] * there[0, j] + here[1, j] * there[1, j]
        upright += here[2, j] * there[2, j]
    change_rad = math.atan2(sine, cosine) + state.reference_rad - state.heading_rad
    state.heading_rad += math.atan2(math.sin(change_rad), math.cos(change_rad))
    if upright < _REFERENCE_COSINE:
        state.reference_nb[:] = here
        state.reference_rad = state.heading_rad


@njit()
def _turn_force(sample: Sample, state: BodyState) -> None:
    force_b = sample.accel_mps2
    for i in range(3):
        row = state.rotation_nb[i]
        state.force_n_mps2[i] = row[0] * force_b[0] + row[1] * force_b[1] + row[2] * force_b[2]


@njit()
def _level(state: BodyState, dt_s: float, config: BodyConfig) -> None:
    """Turn the attitude a little towards the force; fast at first, as a mean over all so far."""
    force = state.force_n_mps2
    size = math.sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2])
    if size < 0.3 * config.gravity_mps2:
        return
    gain = min(dt_s * max(config.levelling_per_s, 1.0 / (state.settled_s + dt_s)), 1.0) / size
    rotate_navigation(state.quaternion_nb, -gain * force[1], gain * force[0], 0.0)


@njit()
def _bridge_gap(state: BodyState, gap_s: float) -> None:
    """Begin levelling again, as the motion in the gap is unknown."""
    state.settled_s = 0.0
    state.covariance[HEADING, HEADING] += (_LOST_TURN_RAD * min(gap_s, 1.0)) ** 2
    state.swings = 0


@njit()
def learn_bias(ring: Ring, state: BodyState, k: int, config: BodyConfig) -> None:
    """Estimate the gyroscope bias once a tick while the person stands; sway is noise."""
    state.bias_variance += config.bias_walk_radps**2 * TICK_S
    rate = ring[k & (len(ring) - 1)].gyro_radps
    off = 0.0
    for i in range(3):
        off += (rate[i] - state.gyro_bias_radps[i]) ** 2
    up_mps2 = -state.force_n_mps2[2]
    if state.ticks == 1:
        state.up_mean_mps2 = up_mps2
    state.up_mean_mps2 += min(TICK_S / 0.5, 1.0) * (up_mps2 - state.up_mean_mps2)
    is_quiet = (
        off < config.rest_rate_radps**2
        and abs(up_mps2 - state.up_mean_mps2) < config.rest_force_mps2
    )
    state.quiet_s = state.quiet_s + TICK_S if is_quiet else 0.0
    if state.quiet_s < config.rest_s:
        return
    gain = state.bias_variance / (state.bias_variance + config.sway_radps**2)
    down, turned_radps = state.rotation_nb[2], 0.0
    for i in range(3):
        off_radps = rate[i] - state.gyro_bias_radps[i]
        state.gyro_bias_radps[i] += gain * off_radps
        turned_radps += down[i] * off_radps
    state.bias_variance *= 1.0 - gain
    update_bias_at_rest(state, turned_radps, gain * turned_radps, config)
