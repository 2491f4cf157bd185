"""Strides of a torso between vertical-straight-line instants (Chiu 2011, section 4.2.3).

Its acceleration is integrated from the velocity of one instant to the next (4.9, 4.10).  What the
two then differ by has grown evenly (4.11), and moves the stride's end by half of that times its
duration (4.12, 4.13).  Rows that have gone before the next instant are predictions; those still
held take up the difference, so the path does not jump.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.torso_shank.state import StrideState, TorsoShankConfig
from edge.tracker.torso_shank.torso_front import add_push, update_front_direction
from edge.tracker.trunk.dead_reckoning import state_errors, take_step
from edge.tracker.trunk.usual_steps import SHORTEST_M, is_usual, length_at, length_std

STEPS = 2  # of a stride


@njit()
def begin_stride(ring: Ring, state: StrideState, k: int, north_mps: float, east_mps: float) -> None:
    """Begin at sample ``k`` with a velocity."""
    trunk = state.waist.trunk
    state.begin_at = k
    state.begin_s = ring[k & (len(ring) - 1)].t_s
    state.begin_distance_m = trunk.distance_m
    state.begin_height_m = trunk.height_m
    for i in range(2):
        state.begin_n_m[i] = trunk.position_n_m[i]
    state.begin_n_mps[0] = state.velocity_n_mps[0] = north_mps
    state.begin_n_mps[1] = state.velocity_n_mps[1] = east_mps
    state.pushed_n_mps[0] = state.pushed_n_mps[1] = 0.0
    state.steps_since_m = 0.0


@njit()
def predict(
    ring: Ring, state: StrideState, k: int, force_n: Floats, config: TorsoShankConfig
) -> None:
    """Follow the acceleration from sample ``k - 1`` to ``k``; it moves the torso in a stride.

    ``force_n`` (2,) is scratch.
    """
    mask = len(ring) - 1
    trunk = state.waist.trunk
    row = ring[k & mask]
    dt_s = row.t_s - ring[(k - 1) & mask].t_s
    if not 0.0 < dt_s <= config.trunk.gap_s:
        return
    add_push(ring, state, k, dt_s, force_n, config)
    if not state.walking:
        return
    for i in range(2):
        trunk.position_n_m[i] += dt_s * (state.velocity_n_mps[i] + 0.5 * dt_s * force_n[i])
        state.velocity_n_mps[i] += dt_s * force_n[i]
    trunk.distance_m = max(trunk.distance_m, state.begin_distance_m + _gone_m(state))
    for i in range(2):
        row.position_n_m[i] = trunk.position_n_m[i]
        row.velocity_n_mps[i] = state.velocity_n_mps[i]
    row.distance_m = trunk.distance_m


@njit()
def _gone_m(state: StrideState) -> float:
    position_n_m = state.waist.trunk.position_n_m
    north_m = position_n_m[0] - state.begin_n_m[0]
    east_m = position_n_m[1] - state.begin_n_m[1]
    return math.sqrt(north_m**2 + east_m**2)


@njit()
def end_stride(
    ring: Ring,
    state: StrideState,
    k: int,
    end_n_mps: Floats,
    is_cut: bool,
    config: TorsoShankConfig,
) -> None:
    """End the stride at sample ``k`` with the velocity (2,) that the torso has there.

    ``is_cut`` says that the wearer has stopped before its other instant.
    """
    mask = len(ring) - 1
    trunk = state.waist.trunk
    lasts_s = ring[k & mask].t_s - state.begin_s
    if lasts_s <= 0.0:
        return
    update_front_direction(state, end_n_mps, config)
    gained_n_mps = np.zeros(2)
    way_n_m = np.zeros(2)
    for i in range(2):
        gained_n_mps[i] = end_n_mps[i] - state.velocity_n_mps[i]
        trunk.position_n_m[i] += 0.5 * gained_n_mps[i] * lasts_s
        way_n_m[i] = trunk.position_n_m[i] - state.begin_n_m[i]
    length_m = math.sqrt(way_n_m[0] ** 2 + way_n_m[1] ** 2)
    released_m = ring[(trunk.released - 1) & mask].distance_m if trunk.released > 0 else 0.0
    std = _stride_std(state, lasts_s, length_m, is_cut, config)
    _count_stride(ring, state, k, way_n_m, length_m, std, config)
    trunk.distance_m = max(state.begin_distance_m + length_m, released_m)
    _correct_rows(ring, state, k, gained_n_mps, lasts_s, released_m, config)
    _learn_ratio(state, length_m, config)


@njit()
def _stride_std(
    state: StrideState, lasts_s: float, length_m: float, is_cut: bool, config: TorsoShankConfig
) -> float:
    """Return the deviation of a stride by its length.

    In one that is not of a usual walk the leg is bent or the body in the air where the shank passes
    the vertical, and its rate is not the body's.  One that a stop cuts short has no frequency of
    steps; its last step is not seen, and that is its doubt.
    """
    usual = config.waist.usual
    if is_cut and lasts_s < STEPS / usual.least_hz:
        doubt_m = length_at(usual.least_hz, usual)
        return float(max(state.leg_std, doubt_m / max(length_m, SHORTEST_M)))
    climbed_m = state.waist.trunk.height_m - state.begin_height_m
    if is_usual(STEPS, lasts_s, climbed_m, usual):
        return float(state.leg_std)
    return float(length_std(STEPS, lasts_s, length_m, state.leg_std, usual))


@njit()
def _count_stride(
    ring: Ring,
    state: StrideState,
    k: int,
    way_n_m: Floats,
    length_m: float,
    std: float,
    config: TorsoShankConfig,
) -> None:
    """Add the errors of the stride; its way is counted already."""
    trunk = state.waist.trunk
    ended_n_m = (trunk.position_n_m[0], trunk.position_n_m[1])
    if length_m > 0.0:
        for i in range(2):
            way_n_m[i] /= length_m
    take_step(trunk, length_m, std, way_n_m, ring[k & (len(ring) - 1)].t_s, config.trunk)
    trunk.position_n_m[0], trunk.position_n_m[1] = ended_n_m
    trunk.steps += 1  # a stride is two steps


@njit()
def _correct_rows(
    ring: Ring,
    state: StrideState,
    k: int,
    gained_n_mps: Floats,
    lasts_s: float,
    released_m: float,
    config: TorsoShankConfig,
) -> None:
    """Correct the rows still held, from where the last released one has left the path."""
    mask = len(ring) - 1
    trunk = state.waist.trunk
    first = max(state.begin_at, trunk.released)
    if first > k:
        return
    from_s = ring[(first - 1) & mask].t_s if first > state.begin_at else state.begin_s
    gone_s = max(from_s - state.begin_s, 0.0)
    for j in range(first, k + 1):
        row = ring[j & mask]
        since_s = row.t_s - state.begin_s
        share = (row.t_s - from_s) / max(lasts_s - gone_s, 1e-6)
        for i in range(2):
            slope_mps2 = gained_n_mps[i] / lasts_s
            row.position_n_m[i] += 0.5 * slope_mps2 * (since_s**2 - (1.0 - share) * gone_s**2)
            row.velocity_n_mps[i] += slope_mps2 * since_s
        from_m = max(released_m, state.begin_distance_m)
        row.distance_m = from_m + share * (trunk.distance_m - from_m)
        row.steps = trunk.steps // 2
        state_errors(trunk, row, config.trunk)


@njit()
def _learn_ratio(state: StrideState, length_m: float, config: TorsoShankConfig) -> None:
    """Learn what the torso's steps are longer than their formula has it."""
    if state.steps_since_m <= 0.0 or not 0.5 < length_m / state.steps_since_m < 2.0:
        return
    state.steps_m += state.steps_since_m
    state.strides_m += length_m
    if state.steps_m > config.ratio_memory_m:
        kept = config.ratio_memory_m / state.steps_m
        state.steps_m *= kept
        state.strides_m *= kept
