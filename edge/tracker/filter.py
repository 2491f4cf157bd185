"""The error-state filter: one sample at a time through prediction and stance updates."""

from __future__ import annotations

import math
from typing import Any

from numba import njit
from numpy.typing import NDArray

from edge.tracker.alignment import level
from edge.tracker.clipping import bridge_clipping
from edge.tracker.conditioning import BAD_SAMPLES, GYRO_SATURATED, SAMPLE_GAP
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    LEVER,
    POSITION,
    SIZE,
    VELOCITY,
    propagate,
)
from edge.tracker.floor import settle
from edge.tracker.stance import stand
from edge.tracker.state import FilterState, Ring, reach
from edge.tracker.strapdown import advance, rotation_matrix
from edge.tracker.verdict import judge, note_faults
from edge.tracker.zero_velocity import stance_threshold

MIN_STRIDE_M = 0.15  # a smaller move is a shuffle: it counts with the next


@njit()
def filter_sample(
    ring: Ring, progress: NDArray[Any], state: FilterState, k: int, config: EskfConfig
) -> None:
    """Take sample ``k`` of the ring into ``state`` and write its row and the smoother's memory."""
    slot = k & (len(ring.t_ns) - 1)
    if ring.flags[slot] & GYRO_SATURATED:
        stop = min(progress[0].measured, reach(ring, k))
        bridge_clipping(ring, k, stop, progress[0].gyro_clip_radps, config)
    good = ring.flags[slot] & BAD_SAMPLES == 0
    if k == 0:
        _start(ring, progress, state, config)
    else:
        _predict(ring, progress, state, k, config)
    ring.updates[slot] = 0
    motion = ring.motion_m2ps4[slot]
    still = good and motion <= stance_threshold(ring.stride_minimum_m2ps4[slot], config)
    if still:
        stand(ring, state, slot, config)
        if motion <= ring.stride_minimum_m2ps4[slot]:
            settle(ring, progress, state, slot, config)
    note_faults(ring, progress, slot)
    _count_steps(progress, state, still, ring.t_s[slot])
    _write_row(ring, progress, state, slot, still)
    judge(ring, progress, state, slot, config)


@njit()
def _start(ring: Ring, progress: NDArray[Any], state: FilterState, config: EskfConfig) -> None:
    stop = min(progress[0].measured, reach(ring, 0))
    ahead_s = config.lookahead_s + config.lag_s
    tilt_std_rad = level(ring, 0, stop, ahead_s, config, state.quaternion_nb)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    moving = ring.motion_m2ps4[0] > config.threshold_min_m2ps4
    speed_std_mps = config.start_speed_std_mps if moving else config.start_still_std_mps
    for i in range(3):
        state.covariance[VELOCITY + i, VELOCITY + i] = speed_std_mps**2
        state.covariance[GYRO_BIAS + i, GYRO_BIAS + i] = config.start_gyro_bias_std_radps**2
        state.covariance[ACCEL_BIAS + i, ACCEL_BIAS + i] = config.start_accel_bias_std_mps2**2
        state.covariance[LEVER + i, LEVER + i] = config.start_lever_std_m**2
    # The heading at the start is the frame's own and therefore known.
    state.covariance[ATTITUDE, ATTITUDE] = tilt_std_rad**2
    state.covariance[ATTITUDE + 1, ATTITUDE + 1] = tilt_std_rad**2
    progress[0].last_stance_s = ring.t_s[0]


@njit()
def _predict(
    ring: Ring, progress: NDArray[Any], state: FilterState, k: int, config: EskfConfig
) -> None:
    mask = len(ring.t_ns) - 1
    slot = k & mask
    before = (k - 1) & mask
    dt_s = ring.t_s[slot] - ring.t_s[before]
    ring.interval_s[slot] = 0.0
    if ring.flags[slot] & SAMPLE_GAP:
        ring.interval_s[slot] = -1.0
        _bridge_gap(ring, progress, state, k, dt_s, config)
        return
    if dt_s == 0.0:
        return
    rate_square = 0.0
    for i in range(3):
        state.accel_mps2[i] = 0.5 * (ring.accel_mps2[slot, i] + ring.accel_mps2[before, i])
        state.accel_mps2[i] -= state.accel_bias_mps2[i]
        rate = 0.5 * (ring.gyro_radps[slot, i] + ring.gyro_radps[before, i])
        state.gyro_radps[i] = rate - state.gyro_bias_radps[i]
        rate_square += state.gyro_radps[i] ** 2
    advance(
        state.position_n_m,
        state.velocity_n_mps,
        state.quaternion_nb,
        state.rotation_nb,
        state.accel_mps2,
        state.gyro_radps,
        config.gravity_mps2,
        dt_s,
        state.force_n_mps2,
        state.angle_rad,
    )
    propagate(state.covariance, state.rotation_nb, state.force_n_mps2, dt_s)
    gyro_noise = config.gyro_noise_radps_rthz**2
    if ring.flags[slot] & GYRO_SATURATED:
        _doubt_clipped(ring, state, slot, dt_s)
    for i in range(3):
        state.covariance[VELOCITY + i, VELOCITY + i] += dt_s * config.accel_noise_mps2_rthz**2
        state.covariance[ATTITUDE + i, ATTITUDE + i] += dt_s * gyro_noise
        state.covariance[GYRO_BIAS + i, GYRO_BIAS + i] += (
            dt_s * config.gyro_bias_walk_radps2_rthz**2
        )
        state.covariance[ACCEL_BIAS + i, ACCEL_BIAS + i] += (
            dt_s * config.accel_bias_walk_mps3_rthz**2
        )
    ring.interval_s[slot] = dt_s
    for i in range(3):
        ring.force_n_mps2[slot, i] = state.force_n_mps2[i]
        for j in range(3):
            ring.rotation_nb[slot, i, j] = state.rotation_nb[i, j]


@njit()
def _doubt_clipped(ring: Ring, state: FilterState, slot: int, dt_s: float) -> None:
    """Widen the attitude about the axes that clipped."""
    rotation = state.rotation_nb
    for axis in range(3):
        variance = ring.hidden_noise[slot, axis] * dt_s
        for i in range(3):
            for j in range(3):
                state.covariance[ATTITUDE + i, ATTITUDE + j] += (
                    rotation[i, axis] * rotation[j, axis] * variance
                )


@njit()
def _bridge_gap(
    ring: Ring,
    progress: NDArray[Any],
    state: FilterState,
    k: int,
    dt_s: float,
    config: EskfConfig,
) -> None:
    """Stand where the samples ceased, level anew, and say how far the foot may have gone."""
    stop = min(progress[0].measured, reach(ring, k))
    tilt_std_rad = level(ring, k, stop, config.lookahead_s, config, state.quaternion_nb)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    turn_std_rad = min(config.gap_turn_std_radps * dt_s, math.pi)
    for i in range(3):
        state.velocity_n_mps[i] = 0.0
        _forget(state, VELOCITY + i, config.gap_speed_std_mps**2)
        _forget(state, ATTITUDE + i, tilt_std_rad**2)
        position = POSITION + i
        state.covariance[position, position] += (config.gap_speed_std_mps * dt_s) ** 2
    heading = ATTITUDE + 2
    state.covariance[heading, heading] += turn_std_rad**2


@njit()
def _forget(state: FilterState, index: int, variance: float) -> None:
    for j in range(SIZE):
        state.covariance[index, j] = 0.0
        state.covariance[j, index] = 0.0
    state.covariance[index, index] = variance


@njit()
def _count_steps(progress: NDArray[Any], state: FilterState, still: bool, t_s: float) -> None:
    memory = progress[0]
    if still and not memory.in_stance:
        memory.stance_since_s = t_s
        north_m = state.position_n_m[0] - memory.foothold_north_m
        east_m = state.position_n_m[1] - memory.foothold_east_m
        moved_m = math.sqrt(north_m * north_m + east_m * east_m)
        if moved_m > MIN_STRIDE_M:
            memory.steps += 1
            memory.distance_m += moved_m
            memory.foothold_north_m = state.position_n_m[0]
            memory.foothold_east_m = state.position_n_m[1]
    if still:
        memory.last_stance_s = t_s
    memory.in_stance = still


@njit()
def _write_row(
    ring: Ring, progress: NDArray[Any], state: FilterState, slot: int, still: bool
) -> None:
    for i in range(3):
        ring.position_n_m[slot, i] = state.position_n_m[i]
        ring.velocity_n_mps[slot, i] = state.velocity_n_mps[i]
    for i in range(4):
        ring.quaternion_nb[slot, i] = state.quaternion_nb[i]
    for i in range(9):
        for j in range(SIZE):
            ring.covariance[slot, i, j] = state.covariance[i, j]
    ring.stationary[slot] = still
    ring.distance_m[slot] = progress[0].distance_m
    ring.steps[slot] = progress[0].steps
