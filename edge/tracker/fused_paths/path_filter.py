"""Filter of two paths of one person: a Kalman filter of the errors of both.

An error of the heading turns what is gone, one of the lengths stretches it.  Two parts of one body
go the same way and stay near each other: over a stride, what lies between them is a short vector
in the mean (a soft form of the bound on the distance of two feet of Prateek, Girisha and Skog
2013).  That measures the difference of the two places, and through what each has gone the
difference of headings and of lengths.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.fused_paths.state import (
    EAST,
    ERRORS,
    HEADING,
    LEAD,
    LENGTH,
    NORTH,
    OTHER,
    FusionConfig,
    FusionState,
    PathState,
)


@njit()
def end_stride(state: FusionState, config: FusionConfig, both: bool, lasts_s: float) -> None:
    """Propagate the errors over the stride that ends, and compare the two places.

    What that moves the fused place by is no movement.
    """
    before_n_m = (fused_m(state, NORTH), fused_m(state, EAST))
    for which in range(2):
        path = state.paths[which]
        if not path.aligned:
            continue
        from_path = which
        if state.paths[1 - which].aligned and not _is_fresh(state, which, config):
            from_path = 1 - which  # it goes with the other
        _propagate(state.covariance, ERRORS * which, path.way_n_m)
        noise_m2 = _widen(path, config, lasts_s)
        if from_path != which:
            noise_m2 += config.apart_std_m**2
        _add_noise(state.covariance, ERRORS * which, noise_m2, path, config, lasts_s)
        path.widening_m2 += config.widening_memory * (noise_m2 - path.widening_m2)
    if both and state.rows > 0:
        _compare(state, config)
    _weigh(state, config)
    for i in range(2):
        state.past_shift_n_m[i] += fused_m(state, i) - before_n_m[i]


@njit()
def fused_m(state: FusionState, axis: int) -> float:
    """Return where the two paths are together."""
    lead, other = state.paths[LEAD], state.paths[OTHER]
    return float(lead.weight * lead.place_n_m[axis] + other.weight * other.place_n_m[axis])


@njit()
def _is_fresh(state: FusionState, which: int, config: FusionConfig) -> bool:
    newest_ns = max(state.paths[LEAD].t_ns, state.paths[OTHER].t_ns)
    return bool((newest_ns - state.paths[which].t_ns) * 1e-9 <= config.silence_s)


@njit()
def _propagate(covariance: Floats, at: int, way_n_m: Floats) -> None:
    """F P F', with F the identity but for the place by heading and length."""
    north_m, east_m = way_n_m[0], way_n_m[1]
    for j in range(len(covariance)):
        heading, length = covariance[at + HEADING, j], covariance[at + LENGTH, j]
        covariance[at + NORTH, j] += north_m * length - east_m * heading
        covariance[at + EAST, j] += east_m * length + north_m * heading
    for j in range(len(covariance)):
        heading, length = covariance[j, at + HEADING], covariance[j, at + LENGTH]
        covariance[j, at + NORTH] += north_m * length - east_m * heading
        covariance[j, at + EAST] += east_m * length + north_m * heading


@njit()
def _widen(path: PathState, config: FusionConfig, lasts_s: float) -> float:
    """Return the variance of a stride's end, as much more as the path's own tracker states."""
    gone_m2 = path.way_n_m[0] ** 2 + path.way_n_m[1] ** 2
    rank = int(path.quality) - 1 if path.quality > 0 else 0
    noise_m2 = config.stride_std[rank] ** 2 * gone_m2
    path.heading_rad2 += config.stride_turn_rad[rank] ** 2 if gone_m2 > 0.0 else 0.0
    alone = path.alone
    _propagate(alone, 0, path.way_n_m)
    _add_noise(alone, 0, noise_m2, path, config, lasts_s)
    more_m2 = 0.5 * max(path.position_m2 - alone[NORTH, NORTH] - alone[EAST, EAST], 0.0)
    alone[NORTH, NORTH] += more_m2
    alone[EAST, EAST] += more_m2
    return float(noise_m2 + more_m2)


@njit()
def _add_noise(
    covariance: Floats,
    at: int,
    noise_m2: float,
    path: PathState,
    config: FusionConfig,
    lasts_s: float,
) -> None:
    covariance[at + NORTH, at + NORTH] += noise_m2
    covariance[at + EAST, at + EAST] += noise_m2
    covariance[at + HEADING, at + HEADING] += (
        path.heading_rad2 + config.heading_walk_rad2ps * lasts_s
    )


@njit()
def _compare(state: FusionState, config: FusionConfig) -> None:
    """Update with what lies between the two: nothing, but for ``compared_std_m``."""
    covariance = state.covariance
    apart_n_m = state.apart_n_m / state.rows
    variance_m2 = _apart_variance(covariance, config.compared_std_m**2)
    off = _solved(variance_m2, apart_n_m)
    if off[0] * apart_n_m[0] + off[1] * apart_n_m[1] > config.outlier_square:
        _inflate_poorer_path(state, apart_n_m)
        variance_m2 = _apart_variance(covariance, config.compared_std_m**2)
        off = _solved(variance_m2, apart_n_m)
    size = 2 * ERRORS
    product = np.zeros((size, 2))  # P H'
    for i in range(size):
        for j in range(2):
            product[i, j] = covariance[i, ERRORS + j] - covariance[i, j]
    for i in range(size):
        along = _solved(variance_m2, product[i])
        for j in range(size):
            covariance[i, j] -= along[0] * product[j, 0] + along[1] * product[j, 1]
    for which in range(2):
        path, at = state.paths[which], ERRORS * which
        error = np.zeros(ERRORS)
        for i in range(ERRORS):
            error[i] = -(product[at + i, 0] * off[0] + product[at + i, 1] * off[1])
        for i in range(2):
            path.place_n_m[i] += error[i]
        path.turn_rad += error[HEADING]
        path.scale *= 1.0 + error[LENGTH]


@njit()
def _apart_variance(covariance: Floats, noise_m2: float) -> Floats:
    variance_m2 = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            variance_m2[i, j] = (
                covariance[i, j]
                + covariance[ERRORS + i, ERRORS + j]
                - covariance[i, ERRORS + j]
                - covariance[ERRORS + i, j]
            )
        variance_m2[i, i] += noise_m2
    return variance_m2


@njit()
def _solved(variance_m2: Floats, vector: Floats) -> Floats:
    """Return the inverse of a matrix (2, 2) times a vector (2,)."""
    determinant = variance_m2[0, 0] * variance_m2[1, 1] - variance_m2[0, 1] * variance_m2[1, 0]
    solved = np.zeros(2)
    solved[0] = (variance_m2[1, 1] * vector[0] - variance_m2[0, 1] * vector[1]) / determinant
    solved[1] = (variance_m2[0, 0] * vector[1] - variance_m2[1, 0] * vector[0]) / determinant
    return solved


@njit()
def _inflate_poorer_path(state: FusionState, apart_n_m: Floats) -> None:
    """Inflate the covariance of the path of poorer quality in this stride, else of both: the two
    contradict each other.
    """
    for which in range(2):
        path = state.paths[which]
        if state.paths[1 - which].poor > path.poor:
            continue
        gone_m2 = max(path.way_n_m[0] ** 2 + path.way_n_m[1] ** 2, 1.0)
        square_m2 = apart_n_m[0] ** 2 + apart_n_m[1] ** 2
        at = ERRORS * which
        state.covariance[at + NORTH, at + NORTH] += square_m2
        state.covariance[at + EAST, at + EAST] += square_m2
        state.covariance[at + HEADING, at + HEADING] += min(square_m2 / gone_m2, 1.0)
        path.widening_m2 += square_m2


@njit()
def _weigh(state: FusionState, config: FusionConfig) -> None:
    """Give each path its weight in the fused place, by what its strides add to the errors."""
    total = 0.0
    for which in range(2):
        path = state.paths[which]
        share = config.share[which] if path.aligned else 0.0
        path.weight = share / (path.widening_m2 + config.least_widening_m2)
        total += path.weight
    if total > 0.0:
        for which in range(2):
            state.paths[which].weight /= total


@njit()
def fused_covariance(state: FusionState, covariance_m2: Floats, config: FusionConfig) -> float:
    """Write the covariance (3, 3) of the fused place; return the variance of its heading.

    It is no smaller than that of the better path alone: what gait and floor do to both is alike.
    """
    heading_rad2 = 0.0
    covariance_m2[:] = 0.0
    for a in range(2):
        for b in range(2):
            weight = state.paths[a].weight * state.paths[b].weight
            for i in range(2):
                for j in range(2):
                    covariance_m2[i, j] += weight * state.covariance[ERRORS * a + i, ERRORS * b + j]
            heading_rad2 += weight * state.covariance[ERRORS * a + HEADING, ERRORS * b + HEADING]
        covariance_m2[2, 2] += state.paths[a].weight * state.paths[a].height_m2
    better = state.paths[LEAD]
    if state.paths[OTHER].weight > better.weight:
        better = state.paths[OTHER]
    fused_m2 = covariance_m2[NORTH, NORTH] + covariance_m2[EAST, EAST]
    alone_m2 = better.alone[NORTH, NORTH] + better.alone[EAST, EAST]
    widening = alone_m2 / fused_m2 if alone_m2 > fused_m2 > 0.0 else 1.0
    for i in range(2):
        for j in range(2):
            covariance_m2[i, j] *= widening
        covariance_m2[i, i] += config.place_std_m**2
    return max(heading_rad2, 0.0)


@njit()
def wrapped(angle_rad: float) -> float:
    """Return an angle within half a turn."""
    return math.atan2(math.sin(angle_rad), math.cos(angle_rad))
