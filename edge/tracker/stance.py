"""What a standing foot tells: it turns about a point that rests, and hardly turns at all.

Zero velocity holds for the point of the sole on the ground, not for a sensor some
centimetres above it on a foot that rolls.  So the velocity is measured as
``rate x lever`` with the lever estimated like a bias: from how the velocity changes
while the rate changes within a stance.  Both pseudo-measurements are worth the more,
the stiller the sample is.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import GYRO_BIAS, VELOCITY
from edge.tracker.intervals import lacks_samples
from edge.tracker.measurement_update import begin_updates, end_updates, measure, measure_with_lever
from edge.tracker.state import FilterState, Ring, Step
from edge.tracker.strapdown import dot

MIN_INTERVAL_S = 2e-4  # a shorter one would make a stance update weigh nothing


@njit()
def stand(ring: Ring, step: Step, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Use the pseudo-measurements of one still sample."""
    interval_s = max(ring[slot].interval_s, MIN_INTERVAL_S)
    if lacks_samples(ring, slot, interval_s):
        interval_s = ring[slot].period_s  # it tells of its own moment, not of the hole
    motion = ring[slot].motion_m2ps4
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
    begin_updates(state)
    velocity_variance = stance_velocity_noise(ring, slot, motion, config) / interval_s
    for i in range(3):
        _measure_velocity(step, state, i, velocity_variance)
    rate_noise = config.stance_rate_radps_rthz**2
    rate_noise += config.stance_rate_per_unrest**2 * ring[slot].unrest_m2ps4 ** 3
    rate_variance = rate_noise / interval_s
    if state.covariance[GYRO_BIAS, GYRO_BIAS] > config.stance_rate_worth_hz * rate_noise:
        for i in range(3):
            measure(step, state, GYRO_BIAS + i, state.gyro_radps[i], rate_variance)
            gain = step.update_gain[step.updates - 1, GYRO_BIAS + i]
            off_mps2 = ring[slot].accel_mps2[i] - state.rest_force_mps2[i]
            state.rest_force_mps2[i] += gain * off_mps2
    end_updates(state)


@njit()
def glides(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> bool:
    """Whether the foot goes evenly where it seems to stand, as one that is dragged does.

    That shows by a velocity that the filter is sure of.  The stillest samples of a stride are
    believed in any case, or a filter that is wrong would never be put right.
    """
    if ring[slot].motion_m2ps4 <= config.threshold_ratio * ring[slot].stride_minimum_m2ps4:
        return False
    for i in range(VELOCITY, VELOCITY + 3):
        speed_mps = state.velocity_n_mps[i - VELOCITY]
        if speed_mps * speed_mps > config.glide_gate**2 * state.covariance[i, i]:
            return True
    return False


@njit()
def stance_velocity_noise(ring: Ring, slot: int, motion: float, config: EskfConfig) -> float:
    """Return the density (m^2/s) of how far a stance sample is from the rolling foot's model."""
    noise = config.stance_velocity_mps_rthz**2
    noise += config.stance_velocity_per_motion**2 * motion
    stillest = max(ring[slot].stride_minimum_m2ps4, config.stance_excess_floor_m2ps4)
    return float(noise * max(motion / stillest, 1.0) ** config.stance_excess_power)


@njit()
def lever_velocity_row(rotation_nb: Floats, rate_b_radps: Floats, axis: int, row: Floats) -> None:
    """Write row ``axis`` of ``R [w x]`` into ``row`` (3,): times the lever it is the velocity."""
    x, y, z = rate_b_radps[0], rate_b_radps[1], rate_b_radps[2]
    row[0] = rotation_nb[axis, 1] * z - rotation_nb[axis, 2] * y
    row[1] = rotation_nb[axis, 2] * x - rotation_nb[axis, 0] * z
    row[2] = rotation_nb[axis, 0] * y - rotation_nb[axis, 1] * x


@njit()
def _measure_velocity(step: Step, state: FilterState, axis: int, variance: float) -> None:
    row = step.lever_row[axis]
    lever_velocity_row(state.rotation_nb, state.gyro_radps, axis, row)
    residual_mps = dot(row, state.lever_b_m) - state.velocity_n_mps[axis]
    measure_with_lever(step, state, axis, row, residual_mps, variance)
