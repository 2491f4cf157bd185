"""A hole in the samples: what the foot may have done meanwhile.

Where one or two samples are missing the cubic through those around goes on (see intervals).  In a
longer hole that is shorter than most of a swing rate and force are taken for straight lines from
its one end to the other, and doubted by what they vary by in the strides around, about and along
the same axes.  What is missed of a swing is mostly a turn about the axis on which a foot
rolls: the next stance puts it right, and the heading knows little of it.  After a longer one
the walk begins anew, where the samples ceased: what follows is levelled by the next stance, and
may be anywhere near.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.alignment import level
from edge.tracker.conditioning import SAMPLE_GAP
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE, POSITION, SIZE, VELOCITY
from edge.tracker.state import FilterState, Progress, Ring, reach, span
from edge.tracker.strapdown import rotate_attitude, rotation_matrix


@njit()
def doubt_hole(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Widen the covariance by what straight lines over the hole before sample ``k`` have missed."""
    first, stop = _around(ring, progress, k, dt_s + config.gap_around_s, config.gap_around_s)
    rates = np.zeros((3, 3))
    forces = np.zeros((3, 3))
    mean_mps2 = np.zeros(3)
    mask = len(ring) - 1
    for n in range(first, stop):
        sample = ring[n & mask]
        for i in range(3):
            mean_mps2[i] += sample.accel_mps2[i] / (stop - first)
            for j in range(3):
                rates[i, j] += sample.gyro_radps[i] * sample.gyro_radps[j] / (stop - first)
                forces[i, j] += sample.accel_mps2[i] * sample.accel_mps2[j] / (stop - first)
    for i in range(3):
        for j in range(3):
            forces[i, j] -= mean_mps2[i] * mean_mps2[j]
    turned = _missed(rates, state.rotation_nb, dt_s, config.gap_rate_s)
    pushed = _missed(forces, state.rotation_nb, dt_s, config.gap_force_s)
    p = state.covariance
    for i in range(3):
        for j in range(3):
            p[ATTITUDE + i, ATTITUDE + j] += turned[i, j]
            p[VELOCITY + i, VELOCITY + j] += pushed[i, j]
            p[POSITION + i, VELOCITY + j] += pushed[i, j] * dt_s / 2.0
            p[VELOCITY + i, POSITION + j] += pushed[i, j] * dt_s / 2.0
            p[POSITION + i, POSITION + j] += pushed[i, j] * dt_s**2 / 3.0


@njit()
def _around(
    ring: Ring, progress: Progress, k: int, before_s: float, after_s: float
) -> tuple[int, int]:
    """Return the first sample and one past the last that are as near to sample ``k``."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    most = min(progress.measured, reach(ring, k))
    first = k
    while first > 0 and k - first < span(ring):
        if now_s - ring[(first - 1) & mask].t_s > before_s:
            break
        first -= 1
    stop = k + 1
    while stop < most and ring[stop & mask].t_s - now_s <= after_s:
        stop += 1
    return first, stop


@njit()
def _missed(squares_b: Floats, rotation_nb: Floats, dt_s: float, keeps_s: float) -> Floats:
    """Return the covariance (3, 3), navigation axes, of the integral that a straight line misses.

    ``squares_b`` (3, 3) is the variance in sensor axes of what goes its way for ``keeps_s``: a
    line is off by a twelfth of the bend times the time cubed, and at most by all of it.
    """
    off_s = min(dt_s**3 / (12.0 * keeps_s**2), dt_s)
    return off_s * off_s * (rotation_nb @ squares_b @ rotation_nb.T)


@njit()
def begins_anew(ring: Ring, k: int, config: EskfConfig) -> bool:
    """Whether nothing is known of the motion before sample ``k``: the first, or after a long hole.

    A foot may swing just then, and is levelled by the next stance, so that is waited for.
    """
    if k == 0:
        return True
    here, before = k & (len(ring) - 1), (k - 1) & (len(ring) - 1)
    hole = ring[here].flags & SAMPLE_GAP != 0
    return bool(hole and ring[here].t_s - ring[before].t_s > config.gap_bridged_s)


@njit()
def stand_over(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Stand where the samples ceased, level anew, and say how far the foot may have gone.

    It is levelled by the smallest turn that does it, which is a turn about a level axis and leaves
    the heading alone; what is known of the turn meanwhile, at either end, comes before that.
    """
    stop = min(progress.measured, reach(ring, k))
    ahead_s = config.lookahead_s + config.lag_s
    mask = len(ring) - 1
    for slot in ((k - 1) & mask, k & mask):
        for i in range(3):
            rate_radps = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
            state.angle_rad[i] = config.gap_rate_s * rate_radps
        rotate_attitude(state.quaternion_nb, state.angle_rad)
    tilt_std_rad = level(ring, k, stop, ahead_s, config, state.quaternion_nb)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    turn_std_rad = min(config.gap_turn_std_radps * dt_s, math.pi)
    for i in range(3):
        state.velocity_n_mps[i] = 0.0
        _forget(state, VELOCITY + i, config.gap_speed_std_mps**2)
        position = POSITION + i
        state.covariance[position, position] += (config.gap_speed_std_mps * dt_s) ** 2
    for i in range(2):
        _forget(state, ATTITUDE + i, tilt_std_rad**2)
    heading = ATTITUDE + 2
    state.covariance[heading, heading] += turn_std_rad**2


@njit()
def open_hole_s(ring: Ring, progress: Progress, slot: int, good: bool, config: EskfConfig) -> float:
    """Return for how long no good sample has come, zero while that may still be bridged.

    The filter's time stands still until the next good one, which then spans the hole; the row of
    a bad sample has to say by itself how far the foot may have gone meanwhile.
    """
    if good or progress.filtered == 0:  # before the first sample nobody went anywhere
        progress.good_ns = ring[slot].t_ns
    open_s = 1e-9 * (ring[slot].t_ns - progress.good_ns)
    return float(open_s) if open_s > config.gap_bridged_s else 0.0


@njit()
def _forget(state: FilterState, index: int, variance: float) -> None:
    for j in range(SIZE):
        state.covariance[index, j] = 0.0
        state.covariance[j, index] = 0.0
    state.covariance[index, index] = variance
