"""Zero-velocity update (ZUPT) of a foot that rolls about a resting point of the sole.

Zero velocity holds for the point of the sole on the ground, not for a sensor some centimetres above
it.  So the pseudo-measurement is ``0 = v - R (rate x lever)`` with the lever (m, sensor axes)
estimated like a bias: from how the velocity changes while the rate changes within a stance.  A
second one, ``0 = rate - bias``, holds once the foot has rested for a while.  Both weigh the more,
the stiller the sample is.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import GYRO_BIAS, VELOCITY
from edge.tracker.foot.filter.initial_gyro_bias import inform_by_rest
from edge.tracker.foot.filter.measurement_update import (
    begin_updates,
    end_updates,
    measure,
    measure_velocity,
)
from edge.tracker.foot.state import FilterState, Progress, Step
from edge.tracker.mechanization.strapdown import dot
from edge.tracker.preprocessing.sample_ring import Ring, reach
from edge.tracker.preprocessing.sample_times import lacks_samples

MIN_INTERVAL_S = 2e-4  # a shorter one would make a stance update weigh nothing


@njit()
def apply_zupt(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Apply the pseudo-measurements of one still sample."""
    interval_s = max(ring[slot].interval_s, MIN_INTERVAL_S)
    if lacks_samples(ring, slot, interval_s):
        interval_s = ring[slot].period_s  # it is evidence of its own instant, not of the gap
    motion = ring[slot].motion_m2ps4
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
    begin_updates(state)
    velocity_variance = stance_velocity_noise(ring, slot, motion, config) / interval_s
    state.stance_nis += _measure_velocity(step, state, velocity_variance)
    rate_noise = config.zupt.stance_rate_radps_rthz**2
    rate_noise += config.zupt.stance_rate_per_unrest**2 * ring[slot].unrest_m2ps4 ** 3
    rate_variance = rate_noise / interval_s
    if state.covariance[GYRO_BIAS, GYRO_BIAS] > config.zupt.stance_rate_gain_min_hz * rate_noise:
        inform_by_rest(state, rate_variance)
        for i in range(3):
            measure(step, state, GYRO_BIAS + i, state.gyro_radps[i], rate_variance)
            gain = step.update_gain[step.updates - 1, GYRO_BIAS + i]
            off_mps2 = ring[slot].accel_mps2[i] - state.rest_force_mps2[i]
            state.rest_force_mps2[i] += gain * off_mps2
    end_updates(state)


@njit()
def is_gliding(
    ring: Ring, progress: Progress, state: FilterState, k: int, config: EskfConfig
) -> bool:
    """True when the foot moves evenly where it seems to stand, as one that is dragged does.

    That shows by a velocity that the filter is sure of.  The stillest sample of all around is used
    in any case, or a filter that is wrong would never be corrected: but for a foot that falls and
    lands soon, for the end of a sprinter's swing is as still as his stance.  A velocity that no
    foot has there is an error of the filter.
    """
    slot = k & (len(ring) - 1)
    if dot(state.velocity_n_mps, state.velocity_n_mps) > config.zupt.glide_fastest_mps**2:
        return False
    down_mps = state.velocity_n_mps[2]
    std_mps = math.sqrt(state.covariance[VELOCITY + 2, VELOCITY + 2])
    # In a fast gait a stance is among the samples of a stride: who refuses more refuses that, too.
    stride_s = config.detection.stride_past_s + config.timing.lookahead_s
    swinging = ring[slot].t_s - progress.last_stance_s <= stride_s
    falling = down_mps > config.zupt.landing_gate * std_mps
    if swinging and falling and _lands_soon(ring, progress, k, config):
        return True
    if ring[slot].motion_m2ps4 <= ring[slot].stride_minimum_m2ps4:
        return False
    for i in range(VELOCITY, VELOCITY + 3):
        speed_mps = state.velocity_n_mps[i - VELOCITY]
        if speed_mps * speed_mps > config.zupt.glide_gate**2 * state.covariance[i, i]:
            return True
    return False


@njit()
def _lands_soon(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> bool:
    """True where a force, and not a rotation, soon makes the foot less still."""
    mask = len(ring) - 1
    restless_m2ps4 = config.detection.threshold_ratio * max(
        ring[k & mask].motion_m2ps4, config.detection.threshold_min_m2ps4
    )
    for i in range(k + 1, min(progress.measured, reach(ring, k))):
        ahead = ring[i & mask]
        if ahead.t_s - ring[k & mask].t_s > config.zupt.landing_ahead_s:
            return False
        if ahead.motion_m2ps4 > restless_m2ps4:
            rate = dot(ahead.gyro_radps, ahead.gyro_radps)
            by_rate = config.detection.rate_weight_m2ps2 * rate
            if by_rate < config.zupt.landing_rate_share * ahead.motion_m2ps4:
                return True
    return False


@njit()
def stance_velocity_noise(ring: Ring, slot: int, motion: float, config: EskfConfig) -> float:
    """Return the density (m^2/s) of how far a stance sample is from the rolling foot's model."""
    noise = config.zupt.stance_velocity_mps_rthz**2
    noise += config.zupt.stance_velocity_per_motion**2 * motion
    stillest = max(ring[slot].stride_minimum_m2ps4, config.zupt.stance_excess_floor_m2ps4)
    return float(noise * max(motion / stillest, 1.0) ** config.zupt.stance_excess_power)


@njit()
def lever_velocity_row(rotation_nb: Floats, rate_b_radps: Floats, axis: int, row: Floats) -> None:
    """Write row ``axis`` of ``R [w x]`` into ``row`` (3,): times the lever it is the velocity."""
    x, y, z = rate_b_radps[0], rate_b_radps[1], rate_b_radps[2]
    row[0] = rotation_nb[axis, 1] * z - rotation_nb[axis, 2] * y
    row[1] = rotation_nb[axis, 2] * x - rotation_nb[axis, 0] * z
    row[2] = rotation_nb[axis, 0] * y - rotation_nb[axis, 1] * x


@njit()
def _measure_velocity(step: Step, state: FilterState, variance: float) -> float:
    residual_mps = state.accel_mps2  # as scratch
    for axis in range(3):
        row = step.lever_row[axis]
        lever_velocity_row(state.rotation_nb, state.gyro_radps, axis, row)
        residual_mps[axis] = dot(row, state.lever_b_m) - state.velocity_n_mps[axis]
    return measure_velocity(step, state, residual_mps, variance)
