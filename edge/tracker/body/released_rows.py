"""Rows: they wait for the step they belong to, and are written as they are released."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.tracker.body.config import BodyConfig
from edge.tracker.body.state import FIELD, HEADING, NORTH, BodyState, Sample, Trail
from edge.tracker.body.walking_direction import direction_rad
from edge.tracker.interface import Quality, Reason
from edge.tracker.mechanization.quasi_static import turn_heading
from edge.tracker.preprocessing.sample_ring import Ring

GOOD, DEGRADED, LOST = int(Quality.GOOD), int(Quality.DEGRADED), int(Quality.LOST)
UNCERTAIN, UNSETTLED = int(Reason.UNCERTAIN), int(Reason.UNSETTLED)

_LEVEL_STD_M = 0.3  # of the height without a barometer, at first
_LEVEL_SLOPE = 0.05  # ... and by the way, as stairs are not seen
_BAROMETER_STD_M = 0.4
_DIRECTION_STD_RAD = 0.15  # of the walking direction that a sensor shows, however long


@njit()
def spread_step(
    ring: Ring, trail: Trail, state: BodyState, k: int, from_s: float, to_s: float, length_m: float
) -> None:
    """Spread a step's way over its samples that are not released, or else over all of those."""
    if _spread(ring, trail, state, k, from_s, to_s, length_m):
        return
    _spread(ring, trail, state, k, -math.inf, math.inf, length_m)


@njit()
def _spread(
    ring: Ring, trail: Trail, state: BodyState, k: int, from_s: float, to_s: float, length_m: float
) -> bool:
    mask = len(ring) - 1
    lasts_s = 0.0
    for j in range(max(state.released, 1), k + 1):
        if from_s < ring[j & mask].t_s <= to_s:
            lasts_s += ring[j & mask].t_s - ring[(j - 1) & mask].t_s
    if lasts_s <= 0.0:
        return False
    for j in range(max(state.released, 1), k + 1):
        if from_s < ring[j & mask].t_s <= to_s:
            trail[j & mask].speed_mps += length_m / lasts_s
    return True


@njit()
def release_to(ring: Ring, trail: Trail, state: BodyState, stop: int, config: BodyConfig) -> None:
    """Write the rows before ``stop`` and count them released."""
    while state.released < stop:
        _write(ring, trail, state, state.released, config)
        state.released += 1


@njit()
def _write(ring: Ring, trail: Trail, state: BodyState, k: int, config: BodyConfig) -> None:
    mask = len(ring) - 1
    row, walked = ring[k & mask], trail[k & mask]
    dt_s = row.t_s - ring[(k - 1) & mask].t_s if k else 0.0
    north, east = math.cos(walked.heading_rad), math.sin(walked.heading_rad)
    way_m = walked.speed_mps * dt_s
    state.position_n_m[0] += way_m * north
    state.position_n_m[1] += way_m * east
    state.distance_m += way_m
    row.position_n_m[0], row.position_n_m[1] = state.position_n_m[0], state.position_n_m[1]
    row.position_n_m[2] = walked.down_m
    row.velocity_n_mps[0] = walked.speed_mps * north
    row.velocity_n_mps[1] = walked.speed_mps * east
    row.velocity_n_mps[2] = 0.0
    _write_errors(row, state, config)
    direction = direction_rad(state)
    turn_heading(row.quaternion_nb, -state.estimate[HEADING] - direction)
    row.stationary = walked.speed_mps == 0.0
    row.distance_m = state.distance_m
    row.steps = state.step_count // 2
    _write_north(row, state, direction)
    _write_quality(row, state, config)


@njit()
def _write_errors(row: Sample, state: BodyState, config: BodyConfig) -> None:
    covariance = state.covariance
    for i in range(3):
        row.position_cov_m2[i, 2] = row.position_cov_m2[2, i] = 0.0
    for i in range(2):
        for j in range(2):
            unusual_m2 = state.unusual_m[i] * state.unusual_m[j]
            row.position_cov_m2[i, j] = covariance[NORTH + i, NORTH + j] + unusual_m2
        row.position_cov_m2[i, i] += config.sway_m**2
    level_m = _LEVEL_STD_M + _LEVEL_SLOPE * state.distance_m
    height_m = level_m if state.pressure_pa == 0.0 else min(level_m, _BAROMETER_STD_M)
    row.position_cov_m2[2, 2] = height_m**2
    row.heading_std_rad = math.sqrt(covariance[HEADING, HEADING])


@njit()
def _write_north(row: Sample, state: BodyState, direction: float) -> None:
    """Magnetic north in the path's frame: the field's direction less that of the walk."""
    covariance, north_ut, east_ut = (
        state.covariance,
        state.estimate[FIELD],
        state.estimate[FIELD + 1],
    )
    row.magnetic_north_rad = math.atan2(east_ut, north_ut) - direction
    row.magnetic_north_std_rad = np.inf
    if state.field_seen and state.direction_weight >= 4.0:
        across = (
            east_ut**2 * covariance[FIELD, FIELD]
            - 2.0 * east_ut * north_ut * covariance[FIELD, FIELD + 1]
            + north_ut**2 * covariance[FIELD + 1, FIELD + 1]
        )
        variance = across / max(north_ut**2 + east_ut**2, 1.0) ** 2
        row.magnetic_north_std_rad = math.sqrt(max(variance, 0.0) + _DIRECTION_STD_RAD**2)


@njit()
def _write_quality(row: Sample, state: BodyState, config: BodyConfig) -> None:
    reasons = row.flags
    if 0.0 <= row.t_s - state.fault_s <= config.fault_s:
        reasons |= state.faults
    is_faulty = reasons != 0
    std_m = math.sqrt(row.position_cov_m2[0, 0] + row.position_cov_m2[1, 1])
    if std_m > config.degraded_m:
        reasons |= UNCERTAIN
    if row.heading_std_rad > config.unsettled_rad:
        reasons |= UNSETTLED
    row.reasons = reasons
    row.quality = DEGRADED if is_faulty or std_m > config.degraded_m else GOOD
    if std_m > config.lost_m:
        row.quality = LOST
