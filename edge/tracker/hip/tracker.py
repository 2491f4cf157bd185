"""Tracker by the method of Hettiarachchige Don (2016): a hip's velocity, modelled in each step.

A state machine finds the steps (``step_machine``).  Within a step the acceleration along the way
is integrated, and a model of the velocity puts it right (``velocity_models``, ``error_state``);
without a model a formula gives the length (``step_length``): step and heading.
Heading and height are those of ``edge.tracker.trunk``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats, SensorDescription
from edge.tracker.hip.error_state import propagate, update
from edge.tracker.hip.indoor_constraints import constrain_heading, end_straight_way
from edge.tracker.hip.state import HIP, NO_MODEL, HipConfig, HipState
from edge.tracker.hip.step_length import step_length_m
from edge.tracker.hip.step_machine import ends_step
from edge.tracker.hip.velocity_models import model_mps
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.attitude import add_forward, level_force
from edge.tracker.trunk.dead_reckoning import (
    begin_walk,
    mean_forward,
    release_standing,
    state_errors,
    take_step,
    write_rows,
)
from edge.tracker.trunk.follow import follow_sample
from edge.tracker.trunk.kernel_tracker import KernelTracker, is_past, new_states, take_times
from edge.tracker.trunk.usual_steps import is_usual, length_std


class HipTracker(KernelTracker):
    """Velocity model, or step and heading; see ``Tracker``."""

    def __init__(self, description: SensorDescription, config: HipConfig | None = None) -> None:
        super().__init__(description, new_states(HIP), walk, config or HipConfig())


@njit(cache=True)
def walk(ring: Ring, states: NDArray[Any], config: HipConfig, final: bool) -> int:
    """Take every sample as far as it can go; return one past the last released row."""
    state = states[0]
    trunk = state.trunk
    take_times(ring, trunk, config.trunk, final)
    angle_b_rad, forward_n, from_n_m = np.zeros(3), np.zeros(2), np.zeros(3)
    while trunk.walked < trunk.timed:
        k = trunk.walked
        if not final and not is_past(ring, trunk, k, config.trunk.lookahead_s):
            break
        follow_sample(ring, trunk, k, angle_b_rad, config.trunk)
        trunk.walked = k + 1
        if ends_step(ring, state, k, config):
            _step(ring, state, k, forward_n, from_n_m, config)
        release_standing(ring, trunk, k, config.trunk)
    if final:
        trunk.released = trunk.walked
    return int(trunk.released)


@njit()
def _step(
    ring: Ring, state: HipState, k: int, forward_n: Floats, from_n_m: Floats, config: HipConfig
) -> None:
    """Take the step that ends with sample ``k``, and write and release its rows."""
    mask = len(ring) - 1
    trunk = state.trunk
    t_s = ring[k & mask].t_s
    state.walking = state.walking and t_s - state.step_s <= config.longest_period_s
    begin = state.step_at + 1 if state.walking else state.began_at
    if not state.walking:
        begin_walk(trunk, config.trunk)
        state.velocity_mps = 0.0
        state.way_cov[:] = 0.0
        end_straight_way(state, t_s)
    period_s = t_s - ring[(begin - 1) & mask].t_s
    first = max(begin, trunk.released)
    mean_forward(ring, trunk, begin, k, forward_n)
    constrain_heading(state, forward_n, t_s, period_s, config)
    for i in range(3):
        from_n_m[i] = trunk.position_n_m[i]
    if config.velocity_model == NO_MODEL:
        from_distance_m = trunk.distance_m
        length_m = step_length_m(state, config)
        std = _length_std(state, period_s, length_m, config)
        take_step(trunk, length_m, std, forward_n, t_s, config.trunk)
        write_rows(ring, trunk, first, k, from_n_m, from_distance_m, config.trunk)
    else:
        _integrate(ring, state, begin, first, k, period_s, from_n_m, config)
    trunk.released = max(trunk.released, k + 1)
    state.step_at = k
    state.step_s = t_s
    state.step_height_m = trunk.height_m
    state.passed_over = 0
    state.walking = True


@njit()
def _length_std(state: HipState, period_s: float, length_m: float, config: HipConfig) -> float:
    """Deviation of the step's length as a share of it; the first of a walk has no period yet."""
    usual, std = config.usual, config.trunk.length_std
    steps, climbed_m = 1 + state.passed_over, state.trunk.height_m - state.step_height_m
    in_air = state.lowest_mps2 < usual.least_force * config.trunk.gravity_mps2
    if not state.walking or (is_usual(steps, period_s, climbed_m, usual) and not in_air):
        return std
    return float(length_std(steps, period_s, length_m, std, usual))


@njit()
def _integrate(
    ring: Ring,
    state: HipState,
    begin: int,
    first: int,
    last: int,
    period_s: float,
    from_n_m: Floats,
    config: HipConfig,
) -> None:
    """Integrate the acceleration along the way of the samples of a step, held by the model.

    Rows before ``first`` have gone.
    """
    mask = len(ring) - 1
    trunk = state.trunk
    from_distance_m = trunk.distance_m
    begin_s = ring[last & mask].t_s - period_s
    way_n_m, forward_n, force_n, error = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    way_m, pushed_mps, corrected = 0.0, 0.0, 0
    for k in range(begin, last + 1):
        row = ring[k & mask]
        dt_s = row.t_s - ring[(k - 1) & mask].t_s
        forward_n[0] = forward_n[1] = 0.0
        add_forward(ring, trunk, k, forward_n)
        level_force(row, force_n)
        before_mps = state.velocity_mps
        if 0.0 < dt_s <= config.trunk.gap_s:
            force_mps2 = force_n[0] * forward_n[0] + force_n[1] * forward_n[1]
            pushed_mps += dt_s * force_mps2
            state.velocity_mps += dt_s * (force_mps2 - state.force_bias_mps2)
            propagate(state.way_cov, dt_s, 0.0, config.force_noise_m2ps3)
        moved_m = 0.5 * dt_s * (before_mps + state.velocity_mps)
        since_s = row.t_s - begin_s
        if since_s * config.corrections >= (corrected + 0.5) * period_s:
            corrected += 1
            off_mps = model_mps(since_s, period_s, config) - state.velocity_mps
            update(state.way_cov, 1, off_mps, config.model_std_mps**2, error)
            moved_m += error[0]
            state.velocity_mps += error[1]
        moved_m = max(moved_m, 0.0)
        way_m += moved_m
        for i in range(2):
            way_n_m[i] += moved_m * forward_n[i]
        if k >= first:
            for i in range(2):
                row.position_n_m[i] = from_n_m[i] + way_n_m[i]
                row.velocity_n_mps[i] = state.velocity_mps * forward_n[i]
            row.distance_m = from_distance_m + way_m
    # What a sensor is tilted, or off by, pushes on and on; a wearer who walks does not.
    mean_mps2 = pushed_mps / period_s
    state.force_bias_mps2 += config.bias_share * (mean_mps2 - state.force_bias_mps2)
    state.way_cov[0, :] = 0.0  # the next step's way begins here
    state.way_cov[1, 0] = 0.0
    length_m = math.sqrt(way_n_m[0] ** 2 + way_n_m[1] ** 2)
    for i in range(2):
        forward_n[i] = way_n_m[i] / max(length_m, 1e-9)
    std = _length_std(state, period_s, length_m, config)
    take_step(trunk, length_m, std, forward_n, ring[last & mask].t_s, config.trunk)
    trunk.distance_m = from_distance_m + way_m
    for k in range(first, last + 1):
        ring[k & mask].steps = trunk.steps // 2
        state_errors(trunk, ring[k & mask], config.trunk)
