"""Scale, misalignment and g-sensitivity errors of the gyroscope: their effect on heading and
position.

The rate that a gyroscope shows is off by a small matrix times the rate, and by another times the
force: eighteen constants ``c``.  The effect of each on the heading is an integral along the walk,
``d heading / d c = integral of (down in sensor axes) (rate or force) dt`` (``heading_sensitivity``,
rad), and on the position the integral of that turn of the velocity (``position_sensitivity``, m).
A swing forth and back cancels most of it, ten turns of a stairwell add up.

All of them turn the walk as a whole, which looks the same to every stance, so stances cannot
observe them, and their effect is known exactly.  Only a compass can observe them.  A constant is
counted in its standard deviations, so that before a compass is used the covariance is the unit
matrix.
"""

from __future__ import annotations

from typing import Any

from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import SIZE, TURN
from edge.tracker.foot.filter.correction_tracking import decorrelate_clone
from edge.tracker.foot.state import SCALE_ERRORS, FilterState


@njit()
def propagate_scale_errors(state: FilterState, dt_s: float, config: EskfConfig) -> float:
    """Add an interval's mean readings; return by how much the known errors turn the walk."""
    scale_errors = state.scale_errors
    by_rate = scale_errors.std * dt_s
    by_force = config.start.gain_per_force * by_rate
    known_rad = 0.0
    for i in range(3):
        down = 0.5 * (scale_errors.down_b[i] + state.rotation_nb[2, i])
        scale_errors.down_b[i] = state.rotation_nb[2, i]
        for j in range(3):
            g = 3 * i + j
            rate = by_rate * down * state.gyro_radps[j]
            force = by_force * down * (state.accel_mps2[j] - state.rest_force_mps2[j])
            scale_errors.heading_sensitivity[g] += rate
            scale_errors.heading_sensitivity[g + 9] += force
            known_rad += scale_errors.estimate[g] * rate + scale_errors.estimate[g + 9] * force
    project(scale_errors, scale_errors.heading_sensitivity, scale_errors.heading_column)
    north_m, east_m = dt_s * state.velocity_n_mps[0], dt_s * state.velocity_n_mps[1]
    _propagate_position(
        scale_errors.position_sensitivity, scale_errors.heading_sensitivity, north_m, east_m
    )
    _propagate_position(scale_errors.position_column, scale_errors.heading_column, north_m, east_m)
    state.covariance[TURN, TURN] = along(
        scale_errors.heading_sensitivity, scale_errors.heading_column
    )
    return known_rad


@njit()
def _propagate_position(position: Floats, heading: Floats, north_m: float, east_m: float) -> None:
    """Turn the way of an interval by ``heading`` (18,) and add it to ``position`` (2, 18).

    The covariance does not change meanwhile, so its products go along with what they are of.
    """
    for g in range(SCALE_ERRORS):
        position[0, g] -= heading[g] * east_m
        position[1, g] += heading[g] * north_m


@njit()
def project(scale_errors: Any, vector: Floats, column: Floats) -> None:
    """Write the covariance of the scale errors times ``vector`` (18,) into ``column`` (18,).

    Its product with another vector is the covariance of both times the errors.
    """
    if not scale_errors.compass_used:
        for g in range(SCALE_ERRORS):
            column[g] = vector[g]
        return
    covariance = scale_errors.covariance
    for g in range(SCALE_ERRORS):
        column[g] = 0.0
    for h in range(0, SCALE_ERRORS, 3):  # so that every element is loaded and stored less often
        a, b, c = vector[h], vector[h + 1], vector[h + 2]
        for g in range(SCALE_ERRORS):
            column[g] += covariance[h, g] * a + covariance[h + 1, g] * b + covariance[h + 2, g] * c


@njit()
def along(vector: Floats, column: Floats) -> float:
    """Return the product of ``vector`` (18,) and ``column`` (18,)."""
    total = 0.0
    for g in range(SCALE_ERRORS):
        total += vector[g] * column[g]
    return total


@njit()
def update_scale_errors(state: FilterState) -> None:
    """Update the scale errors by their share of what a compass has corrected of the turn of the
    walk.

    ``error[TURN]`` is that share, and the covariance of the turn what it has become by it.  Where
    the walk would be had the gains been known is where it is put.
    """
    scale_errors = state.scale_errors
    kept = state.covariance[TURN, TURN]
    for j in range(SIZE):
        state.covariance[TURN, j] = 0.0
        state.covariance[j, TURN] = 0.0
    decorrelate_clone(state, TURN, 0.0)
    scale_errors.compass_used = True
    column = scale_errors.heading_column
    before = along(scale_errors.heading_sensitivity, column)
    if before <= 0.0:
        return
    taken = max(before - kept, 0.0) / (before * before)
    for g in range(SCALE_ERRORS):
        learned = column[g] * state.error[TURN] / before
        scale_errors.estimate[g] += learned
        for i in range(2):
            moved_m = scale_errors.position_sensitivity[i, g] * learned
            state.position_n_m[i] += moved_m
            state.clone.shift_n_m[i] += moved_m
    for g in range(SCALE_ERRORS):
        for h in range(SCALE_ERRORS):
            scale_errors.covariance[h, g] -= taken * column[g] * column[h]
    project(scale_errors, scale_errors.heading_sensitivity, column)
    for i in range(2):
        project(scale_errors, scale_errors.position_sensitivity[i], scale_errors.position_column[i])
    state.covariance[TURN, TURN] = kept
