"""Kernel of the fusion: rows of both paths in, rows of the fused path out."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats
from edge.tracker.fused_paths.follow import (
    ends_stride,
    follow_row,
    fused_place_m,
    silent_s,
    take_stride,
)
from edge.tracker.fused_paths.path_filter import fused_covariance
from edge.tracker.fused_paths.state import LEAD, FusionConfig, FusionState, PathState
from edge.tracker.interface import Quality, Reason
from edge.tracker.mechanization.quasi_static import turn_heading

GOOD, DEGRADED, LOST = int(Quality.GOOD), int(Quality.DEGRADED), int(Quality.LOST)
UNCERTAIN, SAMPLE_GAP = int(Reason.UNCERTAIN), int(Reason.SAMPLE_GAP)


class Columns(NamedTuple):
    """Columns of a ``TrackBatch`` in its order; kernels take tuples of arrays."""

    t_ns: NDArray[np.int64]
    position_n_m: Floats
    velocity_n_mps: Floats
    quaternion_nb: Floats
    position_cov_m2: Floats
    heading_std_rad: Floats
    stationary: NDArray[np.bool_]
    past_shift_n_m: Floats
    past_turn_rad: Floats
    distance_m: Floats
    steps: NDArray[np.int64]
    quality: NDArray[np.uint8]
    reasons: NDArray[np.uint32]
    magnetic_north_rad: Floats
    magnetic_north_std_rad: Floats


@njit(cache=True)
def fuse(
    states: NDArray[Any],
    rows: Columns,
    sensors: NDArray[np.int64],
    fused: Columns,
    config: FusionConfig,
) -> int:
    """Take rows in the order of their times; return how many rows of ``fused`` were written.

    ``sensors`` (n,): which path each is of.  The leading path's rows become the fused path's, or
    the other's while the leading one is silent.
    """
    state = states[0]
    before_n_m = np.zeros(3)
    written = 0
    for k in range(len(sensors)):
        which, t_ns = sensors[k], rows.t_ns[k]
        path = state.paths[which]
        _take(state, path, rows, k, which, before_n_m, config)
        if ends_stride(state, t_ns, config):
            take_stride(state, t_ns, config)
        if which == LEAD or silent_s(state, LEAD, t_ns) > config.silence_s:
            _write(state, which, rows, k, fused, written, config)
            written += 1
    return written


@njit()
def _take(
    state: FusionState,
    path: PathState,
    rows: Columns,
    k: int,
    which: int,
    before_n_m: Floats,
    config: FusionConfig,
) -> None:
    """Take a row into its path, and what it adds to distance, strides and corrections."""
    t_ns = rows.t_ns[k]
    is_alone = silent_s(state, 1 - which, t_ns) > config.silence_s
    if path.seen:
        before_n_m[:] = path.position_n_m
    else:
        before_n_m[:] = rows.position_n_m[k]
    path.position_n_m[:] = rows.position_n_m[k]
    if path.seen and silent_s(state, which, t_ns) <= config.silence_s:
        gone_m = rows.distance_m[k] - path.distance_m
        state.distance_m += gone_m * (path.scale if is_alone else config.share[which])
        if is_alone or which == LEAD:
            state.strides += rows.steps[k] - path.steps
        shift_n_m = rows.past_shift_n_m[k] - path.past_shift_n_m
        cos, sin = math.cos(path.turn_rad), math.sin(path.turn_rad)
        share = 1.0 if is_alone else path.weight
        state.past_shift_n_m[0] += share * (cos * shift_n_m[0] - sin * shift_n_m[1])
        state.past_shift_n_m[1] += share * (sin * shift_n_m[0] + cos * shift_n_m[1])
        state.past_turn_rad += share * (rows.past_turn_rad[k] - path.past_turn_rad)
    std_rad = rows.heading_std_rad[k]
    path.heading_rad2 += max(std_rad**2 - path.heading_std_rad**2, 0.0) if path.seen else 0.0
    covariance_m2 = rows.position_cov_m2[k]
    path.position_m2 = covariance_m2[0, 0] + covariance_m2[1, 1]
    path.height_m2 = covariance_m2[2, 2]
    path.distance_m, path.steps = rows.distance_m[k], rows.steps[k]
    path.past_shift_n_m[:] = rows.past_shift_n_m[k]
    path.past_turn_rad, path.heading_std_rad = rows.past_turn_rad[k], std_rad
    path.velocity_n_mps[:] = rows.velocity_n_mps[k]
    path.stationary, path.quality = rows.stationary[k], rows.quality[k]
    path.poor += 1 if path.quality != GOOD else 0
    follow_row(state, which, t_ns, before_n_m, config)
    path.seen, path.t_ns = True, t_ns


@njit()
def _write(
    state: FusionState,
    which: int,
    rows: Columns,
    k: int,
    fused: Columns,
    at: int,
    config: FusionConfig,
) -> None:
    """Write the fused row beside row ``k`` of a path."""
    path, companion = state.paths[which], state.paths[1 - which]
    t_ns = rows.t_ns[k]
    alone = silent_s(state, 1 - which, t_ns) > config.silence_s
    north_m, east_m, down_m = fused_place_m(state, which)
    fused.t_ns[at] = t_ns
    fused.position_n_m[at, 0], fused.position_n_m[at, 1] = north_m, east_m
    fused.position_n_m[at, 2] = down_m
    fused.velocity_n_mps[at] = 0.0
    for one in range(2):
        mover = state.paths[which] if alone else state.paths[one]
        cos, sin = math.cos(mover.turn_rad), math.sin(mover.turn_rad)
        weight = state.paths[one].weight
        velocity = mover.velocity_n_mps
        fused.velocity_n_mps[at, 0] += weight * (cos * velocity[0] - sin * velocity[1])
        fused.velocity_n_mps[at, 1] += weight * (sin * velocity[0] + cos * velocity[1])
        fused.velocity_n_mps[at, 2] += weight * velocity[2]
    fused.quaternion_nb[at] = rows.quaternion_nb[k]
    turn_heading(fused.quaternion_nb[at], path.turn_rad)
    heading_rad2 = fused_covariance(state, fused.position_cov_m2[at], config)
    fused.heading_std_rad[at] = math.sqrt(heading_rad2)
    fused.stationary[at] = path.stationary  # of this foot: two are at rest together only in a halt
    fused.past_shift_n_m[at] = state.past_shift_n_m
    fused.past_turn_rad[at] = state.past_turn_rad
    fused.distance_m[at] = state.distance_m
    fused.steps[at] = state.strides
    fused.magnetic_north_rad[at] = rows.magnetic_north_rad[k] + path.turn_rad
    fused.magnetic_north_std_rad[at] = rows.magnetic_north_std_rad[k]
    covariance_m2 = fused.position_cov_m2[at]
    std_m = math.sqrt(covariance_m2[0, 0] + covariance_m2[1, 1])
    better_is_good = path.quality == GOOD or (not alone and companion.quality == GOOD)
    reasons = 0 if better_is_good else rows.reasons[k]
    if alone:
        reasons |= SAMPLE_GAP
    quality = GOOD if better_is_good and not alone else DEGRADED
    if std_m > config.degraded_m:
        reasons |= UNCERTAIN
        quality = DEGRADED
    both_lost = path.quality == LOST and (alone or companion.quality == LOST)
    fused.reasons[at] = reasons
    fused.quality[at] = LOST if std_m > config.lost_m or both_lost else quality
