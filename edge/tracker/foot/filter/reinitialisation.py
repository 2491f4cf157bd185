"""Initialisation of the filter after a long gap, over which no earlier stride shows what the foot
did.

The walk continues where the samples ended: the motion that follows is levelled by the next stance,
and its position is uncertain by a walk of that duration.  (For shorter gaps see gap_filling.)
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, POSITION, SIZE, VELOCITY
from edge.tracker.foot.filter.alignment import level
from edge.tracker.foot.filter.correction_tracking import decorrelate_clone
from edge.tracker.foot.filter.gap_turn import add_gap_turn
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.mechanization.strapdown import rotate_attitude, rotation_matrix
from edge.tracker.preprocessing.preprocess import SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring, reach


@njit()
def is_long_gap(ring: Ring, k: int, config: EskfConfig) -> bool:
    """True when nothing can show the motion before ``k``: the first sample, or a long gap."""
    return k == 0 or _gap_s(ring, k) > config.gap.similar_longest_s


@njit()
def needs_reinitialisation(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> bool:
    """True when nothing shows the motion before sample ``k``, no similar stride either.

    A foot may swing just then, and is levelled by the next stance, so that is waited for.
    """
    if is_long_gap(ring, k, config):
        return True
    return bool(progress.similar_count == 0 and _gap_s(ring, k) > config.gap.bridged_s)


@njit()
def _gap_s(ring: Ring, k: int) -> float:
    here, before = ring[k & (len(ring) - 1)], ring[(k - 1) & (len(ring) - 1)]
    return float(here.t_s - before.t_s) if here.flags & SAMPLE_GAP else 0.0


@njit()
def reinitialise(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Stop where the samples ended, level again, and widen by how far the foot may have gone.

    It is levelled by the smallest turn that does it, which is a turn about a level axis and leaves
    the heading alone; what is known of the turn meanwhile, at either end, comes before that.
    """
    stop = min(progress.measured, reach(ring, k))
    ahead_s = config.timing.lookahead_s + config.timing.lag_s
    mask = len(ring) - 1
    for slot in ((k - 1) & mask, k & mask):
        for i in range(3):
            rate_radps = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
            state.angle_rad[i] = config.gap.rate_s * rate_radps
        rotate_attitude(state.quaternion_nb, state.angle_rad)
    tilt_std_rad = level(ring, k, stop, ahead_s, config, state.quaternion_nb)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    turn_std_rad = min(config.restart.turn_std_radps * dt_s, math.pi)
    for i in range(3):
        state.velocity_n_mps[i] = 0.0
        _reset_error(state, VELOCITY + i, config.restart.speed_std_mps**2)
        position = POSITION + i
        state.covariance[position, position] += (config.restart.speed_std_mps * dt_s) ** 2
    for i in range(2):
        _reset_error(state, ATTITUDE + i, tilt_std_rad**2)
    heading = ATTITUDE + 2
    state.covariance[heading, heading] += turn_std_rad**2
    add_gap_turn(state, turn_std_rad**2)


@njit()
def open_gap_s(ring: Ring, progress: Progress, slot: int, good: bool, config: EskfConfig) -> float:
    """Return for how long no good sample has come, zero while that may still be filled.

    The filter's time stands still until the next good one, which then spans the hole; the row of
    a bad sample has to say by itself how far the foot may have gone meanwhile.
    """
    if good or progress.filtered == 0:  # before the first sample there is no motion
        progress.good_ns = ring[slot].t_ns
    open_s = 1e-9 * (ring[slot].t_ns - progress.good_ns)
    return float(open_s) if open_s > config.gap.bridged_s else 0.0


@njit()
def _reset_error(state: FilterState, index: int, variance: float) -> None:
    for j in range(SIZE):
        state.covariance[index, j] = 0.0
        state.covariance[j, index] = 0.0
    state.covariance[index, index] = variance
    decorrelate_clone(state, index, 0.0)
