"""Rows of two paths, one by one in the order of their times: the fused path moves with both.

A path whose sensor is silent goes as the other does.  The heading of each path's frame is
arbitrary: that of the first one that is there is the fused path's, and the other's is compared
with it once both have gone some way.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.fused_paths.path_filter import end_stride, fused_m, wrapped
from edge.tracker.fused_paths.state import (
    EAST,
    ERRORS,
    HEADING,
    LEAD,
    LENGTH,
    NORTH,
    FusionConfig,
    FusionState,
    PathState,
)


@njit()
def silent_s(state: FusionState, which: int, t_ns: int) -> float:
    """Return for how long a path has had no row at a time."""
    path = state.paths[which]
    return float(t_ns - (path.t_ns if path.seen else state.began_ns)) * 1e-9


@njit()
def follow_row(
    state: FusionState, which: int, t_ns: int, position_n_m: Floats, config: FusionConfig
) -> None:
    """Move the fused path by a row; ``position_n_m`` (3,) is what the row before had."""
    path, companion = state.paths[which], state.paths[1 - which]
    if not state.begun:
        state.begun, state.began_ns, state.stride_ns = True, t_ns, t_ns
    gap_s = silent_s(state, which, t_ns)
    goes_alone = silent_s(state, 1 - which, t_ns) > config.silence_s
    moved_n_m = (path.position_n_m[0] - position_n_m[0], path.position_n_m[1] - position_n_m[1])
    if not path.seen:
        companion.alignment_n_m[:] = 0.0
    elif gap_s > config.silence_s and companion.aligned:
        moved_n_m = (0.0, 0.0)  # it has gone with the other meanwhile
        if gap_s > config.forgotten_s:
            _forget(state, which)
    path.alignment_n_m[0] += moved_n_m[0]
    path.alignment_n_m[1] += moved_n_m[1]
    if not path.aligned and not companion.aligned and (which == LEAD or goes_alone):
        _begin(state, which, config)
    elif goes_alone and not path.aligned:
        _align(state, config, True)
    if path.aligned:
        _move(state, which, moved_n_m, goes_alone)
    path.since_n_m[0] = path.since_n_m[1] = 0.0
    both = state.paths[0].aligned and state.paths[1].aligned
    if both and not goes_alone:
        state.rows += 1
        for i in range(2):
            lies_m = state.paths[1].place_n_m[i] - state.paths[0].place_n_m[i]
            state.apart_n_m[i] += lies_m


@njit()
def _begin(state: FusionState, which: int, config: FusionConfig) -> None:
    path = state.paths[which]
    path.aligned, path.weight, path.scale = True, 1.0, 1.0
    at = ERRORS * which
    state.covariance[at + LENGTH, at + LENGTH] = config.length_std[which] ** 2
    path.alone[LENGTH, LENGTH] = config.length_std[which] ** 2


@njit()
def _forget(state: FusionState, which: int) -> None:
    """Leave a path out until its heading has been compared anew."""
    path, companion = state.paths[which], state.paths[1 - which]
    before_n_m = (fused_m(state, NORTH), fused_m(state, EAST))
    path.aligned, path.weight, companion.weight = False, 0.0, 1.0
    path.alignment_n_m[:] = 0.0
    companion.alignment_n_m[:] = 0.0
    for i in range(2):
        state.past_shift_n_m[i] += fused_m(state, i) - before_n_m[i]


@njit()
def _move(
    state: FusionState,
    which: int,
    moved_n_m: tuple[float, float],
    goes_alone: bool,
) -> None:
    path, companion = state.paths[which], state.paths[1 - which]
    cos, sin = path.scale * math.cos(path.turn_rad), path.scale * math.sin(path.turn_rad)
    way_n_m = (
        cos * moved_n_m[0] - sin * moved_n_m[1],
        sin * moved_n_m[0] + cos * moved_n_m[1],
    )
    for i in range(2):
        path.place_n_m[i] += way_n_m[i]
        path.way_n_m[i] += way_n_m[i]
        companion.since_n_m[i] += way_n_m[i]
    if goes_alone and companion.aligned:
        for i in range(2):
            companion.place_n_m[i] += companion.since_n_m[i]
            companion.way_n_m[i] += companion.since_n_m[i]
            companion.since_n_m[i] = 0.0


@njit()
def ends_stride(state: FusionState, t_ns: int, config: FusionConfig) -> bool:
    """Return True if a stride of the leading path has ended, or a way without any."""
    lead, other = state.paths[0], state.paths[1]
    path = lead if silent_s(state, LEAD, t_ns) <= config.silence_s else other
    if path.steps != state.stride_steps:
        return True
    if (t_ns - state.stride_ns) * 1e-9 < config.longest_stride_s:
        return False
    gone_m = abs(path.way_n_m[0]) + abs(path.way_n_m[1])
    return bool(gone_m > config.least_way_m or path.heading_rad2 > 0.0)


@njit()
def take_stride(state: FusionState, t_ns: int, config: FusionConfig) -> None:
    """End a stride at the row of a time."""
    lead, other = state.paths[0], state.paths[1]
    lead_here = silent_s(state, 0, t_ns) <= config.silence_s
    both = lead_here and silent_s(state, 1, t_ns) <= config.silence_s
    end_stride(
        state, config, both and lead.aligned and other.aligned, (t_ns - state.stride_ns) * 1e-9
    )
    if both and lead.aligned != other.aligned:
        _align(state, config, False)
    state.stride_ns = t_ns
    state.stride_steps = lead.steps if lead_here else other.steps
    state.rows = 0
    state.apart_n_m[:] = 0.0
    for which in range(2):
        path = state.paths[which]
        path.way_n_m[:] = 0.0
        path.heading_rad2 = 0.0
        path.poor = 0


@njit()
def _align(state: FusionState, config: FusionConfig, at_once: bool) -> None:
    """Compare the heading of a path with the other's, once both have gone far enough.

    ``at_once``: by what there is, as the other is gone.
    """
    which = 0 if state.paths[1].aligned else 1
    path, companion = state.paths[which], state.paths[1 - which]
    gone_m = min(_length_m(path), _length_m(companion))
    if gone_m < config.alignment_m and not at_once:
        return
    path.turn_rad = companion.turn_rad
    if gone_m > 0.0:
        path.turn_rad += wrapped(
            math.atan2(companion.alignment_n_m[1], companion.alignment_n_m[0])
            - math.atan2(path.alignment_n_m[1], path.alignment_n_m[0])
        )
    apart_rad = math.sqrt(2.0) * config.alignment_apart_m / max(gone_m, config.alignment_apart_m)
    _place_with_companion(state, which, apart_rad, config)


@njit()
def _place_with_companion(
    state: FusionState, which: int, apart_rad: float, config: FusionConfig
) -> None:
    """Put a path where the other is, with its heading but for ``apart_rad``."""
    path, companion = state.paths[which], state.paths[1 - which]
    at, beside = ERRORS * which, ERRORS * (1 - which)
    covariance = state.covariance
    covariance[at : at + ERRORS, :] = 0.0
    covariance[:, at : at + ERRORS] = 0.0
    for i in (NORTH, EAST, HEADING):
        covariance[at + i, :] = covariance[beside + i, :]
    for i in (NORTH, EAST, HEADING):
        covariance[:, at + i] = covariance[:, beside + i]
    for i in (NORTH, EAST):
        covariance[at + i, at + i] += config.apart_std_m**2
        path.place_n_m[i] = companion.place_n_m[i]
    covariance[at + HEADING, at + HEADING] += apart_rad**2
    covariance[at + LENGTH, at + LENGTH] = config.length_std[which] ** 2
    path.alone[:] = 0.0
    path.alone[NORTH, NORTH] = path.alone[EAST, EAST] = 0.5 * path.position_m2
    path.alone[LENGTH, LENGTH] = config.length_std[which] ** 2
    path.scale, path.aligned = 1.0, True


@njit()
def _length_m(path: PathState) -> float:
    return math.sqrt(path.alignment_n_m[0] ** 2 + path.alignment_n_m[1] ** 2)


@njit()
def fused_place_m(state: FusionState, which: int) -> tuple[float, float, float]:
    """Return the fused place, whose height is the weighted mean of both."""
    lead, other = state.paths[0], state.paths[1]
    if lead.weight + other.weight == 0.0:
        path = state.paths[which]
        return (path.position_n_m[0], path.position_n_m[1], path.position_n_m[2])
    down_m = lead.weight * lead.position_n_m[2] + other.weight * other.position_n_m[2]
    return (fused_m(state, NORTH), fused_m(state, EAST), down_m)
