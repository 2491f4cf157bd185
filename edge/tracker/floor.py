"""Flat floors, told from stairs and ramps by the steps themselves.

People in buildings walk on level floors most of the time, and an inertial height
drifts by a centimetre or two a stride.  A footfall that rises by less than a stair
belongs to the floor of the one before.  A stride that rises more is a stair or a
kerb and starts a new level.  Strides that all rise a little are a ramp: then the
floor stops correcting and gives back what it took out.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import POSITION, SIZE
from edge.tracker.measuring import remember
from edge.tracker.state import FilterState, Progress, Ring

DOWN = POSITION + 2


@njit()
def settle(
    ring: Ring, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Look at the floor once a stance, at its stillest sample."""
    if progress.on_floor and ring[slot].t_s - progress.footfall_s < config.floor_pause_s:
        return
    sink_m = state.position_n_m[2] - progress.footfall_m
    if progress.on_floor and _is_flat(progress, sink_m, config):
        _hold_level(ring, progress, state, slot, config)
    else:
        _enter_level(progress, state)
    progress.footfall_m = state.position_n_m[2]
    progress.footfall_s = ring[slot].t_s


@njit()
def _hold_level(
    ring: Ring, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    off_m = progress.level_m - state.position_n_m[2]
    if off_m * progress.withheld_m < 0.0:
        progress.withheld_m = 0.0
    progress.withheld_m += off_m
    variance_m2 = config.floor_std_m**2 + progress.level_variance_m2
    _measure_height_only(ring, state, slot, off_m, variance_m2)
    # The floor is no better known than when it was entered.
    state.covariance[DOWN, DOWN] = max(state.covariance[DOWN, DOWN], progress.level_variance_m2)


@njit()
def _measure_height_only(
    ring: Ring, state: FilterState, slot: int, off_m: float, variance_m2: float
) -> None:
    """Correct the height and nothing else (Schmidt's consider filter).

    Were a gentle ramp allowed to teach the biases that it is flat, it would never show.
    """
    p = state.covariance
    weight = 1.0 / (p[DOWN, DOWN] + variance_m2)
    gain = p[DOWN, DOWN] * weight
    kept = p[DOWN, DOWN] * (1.0 - gain)
    for j in range(SIZE):
        p[DOWN, j] *= 1.0 - gain
        p[j, DOWN] = p[DOWN, j]
    p[DOWN, DOWN] = kept
    state.position_n_m[2] += gain * off_m
    u = ring[slot].updates
    for j in range(SIZE):
        ring[slot].update_gain[u, j] = 0.0
    ring[slot].update_gain[u, DOWN] = gain
    remember(ring, slot, DOWN, weight * off_m)


@njit()
def _enter_level(progress: Progress, state: FilterState) -> None:
    """Take the height as it is for the level, with what a ramp had lost to the one before."""
    state.position_n_m[2] -= progress.withheld_m
    state.covariance[DOWN, DOWN] += progress.withheld_m**2
    progress.withheld_m = 0.0
    progress.on_floor = True
    progress.level_m = state.position_n_m[2]
    progress.level_variance_m2 = state.covariance[DOWN, DOWN]


@njit()
def _is_flat(progress: Progress, sink_m: float, config: EskfConfig) -> bool:
    if abs(sink_m) >= config.floor_gate_m:
        progress.mean_sink_m = 0.0
        progress.withheld_m = 0.0
        return False
    progress.mean_sink_m += (sink_m - progress.mean_sink_m) / config.floor_ramp_strides
    return bool(abs(progress.mean_sink_m) < config.floor_ramp_m and not progress.floor_doubted)
