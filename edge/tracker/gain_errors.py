"""What scale, axes and sensitivity to force of the gyroscope make of heading and position.

The rate that a gyroscope shows is off by a small matrix times the rate, and by another times the
force: eighteen constants.  What each has made of the heading is an integral along the walk that
needs no filter: a swing forth and back takes back most of what it adds, ten turns of a
stairwell add up.  All of them turn the walk as a whole, which looks the same to every stance; so
stances tell nothing of them, and what they do is known exactly.  Only a compass tells of them.

A constant is counted in its standard deviations, so that before a compass is heard the
covariance is the unit matrix.
"""

from __future__ import annotations

from typing import Any

from numba import njit

from edge.samples import Floats
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import SIZE, TURN
from edge.tracker.past import forget_with_past
from edge.tracker.state import GAIN_ERRORS, FilterState


@njit()
def follow_gain_errors(state: FilterState, dt_s: float, config: EskfConfig) -> float:
    """Take an interval's mean readings in; return by how much the known errors turn the walk."""
    gains = state.gains
    by_rate = gains.std * dt_s
    by_force = config.gain_per_force * by_rate
    known_rad = 0.0
    for i in range(3):
        down = 0.5 * (gains.down_b[i] + state.rotation_nb[2, i])
        gains.down_b[i] = state.rotation_nb[2, i]
        for j in range(3):
            g = 3 * i + j
            rate = by_rate * down * state.gyro_radps[j]
            force = by_force * down * (state.accel_mps2[j] - state.rest_force_mps2[j])
            gains.turned_rad[g] += rate
            gains.turned_rad[g + 9] += force
            known_rad += gains.estimate[g] * rate + gains.estimate[g + 9] * force
    north_m, east_m = dt_s * state.velocity_n_mps[0], dt_s * state.velocity_n_mps[1]
    for g in range(GAIN_ERRORS):
        gains.carried_m[0, g] -= gains.turned_rad[g] * east_m
        gains.carried_m[1, g] += gains.turned_rad[g] * north_m
    project(gains, gains.turned_rad, gains.turned_column)
    state.covariance[TURN, TURN] = along(gains.turned_rad, gains.turned_column)
    return known_rad


@njit()
def project(gains: Any, vector: Floats, column: Floats) -> None:
    """Write the gains' covariance times ``vector`` (18,) into ``column`` (18,).

    Its product with another vector is the covariance of both times the errors.
    """
    if not gains.heard:
        for g in range(GAIN_ERRORS):
            column[g] = vector[g]
        return
    for g in range(GAIN_ERRORS):
        column[g] = 0.0
    for h in range(GAIN_ERRORS):
        share = vector[h]
        for g in range(GAIN_ERRORS):
            column[g] += gains.covariance[h, g] * share


@njit()
def along(vector: Floats, column: Floats) -> float:
    """Return the product of ``vector`` (18,) and ``column`` (18,)."""
    total = 0.0
    for g in range(GAIN_ERRORS):
        total += vector[g] * column[g]
    return total


@njit()
def learn_gain_errors(state: FilterState) -> None:
    """Give the gains their share of what a compass has just told of the turn of the walk.

    ``error[TURN]`` is that share, and the covariance of the turn what it has become by it.  Where
    the walk would be had the gains been known is where it is put.
    """
    gains = state.gains
    kept = state.covariance[TURN, TURN]
    for j in range(SIZE):
        state.covariance[TURN, j] = 0.0
        state.covariance[j, TURN] = 0.0
    forget_with_past(state, TURN, 0.0)
    gains.heard = True
    column = gains.turned_column
    before = along(gains.turned_rad, column)
    if before <= 0.0:
        return
    taken = max(before - kept, 0.0) / (before * before)
    for g in range(GAIN_ERRORS):
        learned = column[g] * state.error[TURN] / before
        gains.estimate[g] += learned
        for i in range(2):
            moved_m = gains.carried_m[i, g] * learned
            state.position_n_m[i] += moved_m
            state.past.shift_n_m[i] += moved_m
    for g in range(GAIN_ERRORS):
        for h in range(GAIN_ERRORS):
            gains.covariance[h, g] -= taken * column[g] * column[h]
    project(gains, gains.turned_rad, column)
    state.covariance[TURN, TURN] = kept
