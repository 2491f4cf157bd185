"""Filter stages of one sample, in order; the order in ``filter_sample`` is the specification.

Each stage reads the sample's record in the ring and what earlier stages have written.  ``Trail``
keeps what the smoother needs to go back over the sample; ``Progress`` what lasts from sample to
sample beside the filter's state.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.aiding.barometric_height import update_barometer
from edge.tracker.foot.aiding.magnetic_heading import update_magnetometer
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    GYRO_BIAS_PER_K,
    LEVER,
    VELOCITY,
)
from edge.tracker.foot.filter.alignment import level
from edge.tracker.foot.filter.bridge_scale import propagate_bridge, start_bridges
from edge.tracker.foot.filter.correction_tracking import accept_heading, propagate_clone
from edge.tracker.foot.filter.error_model import propagate
from edge.tracker.foot.filter.gap_filling import inflate_for_gap, propagate_through_gap
from edge.tracker.foot.filter.gap_turn import propagate_gap_turn
from edge.tracker.foot.filter.initial_gyro_bias import inflate_bias, learn_from_stance
from edge.tracker.foot.filter.integration import integrate, mean_readings
from edge.tracker.foot.filter.measurement_update import rotate_state
from edge.tracker.foot.filter.reinitialisation import open_gap_s, reinitialise
from edge.tracker.foot.filter.scale_misalignment import propagate_scale_errors
from edge.tracker.foot.filter.temperature_bias import update_temperature_bias
from edge.tracker.foot.filter.unstamped_loss_propagation import hold_readings, inflate_for_loss
from edge.tracker.foot.output.hidden_turn import add_hidden_turn, propagate_hidden_turn
from edge.tracker.foot.output.quality import assign_quality, note_faults
from edge.tracker.foot.output.reported_covariance import accumulate_heading_bias, report_covariance
from edge.tracker.foot.preprocessing.saturation_recovery import recover_forces, recover_rates
from edge.tracker.foot.preprocessing.unstamped_loss import unstamped_loss_s
from edge.tracker.foot.state import FilterState, Progress, Step, Trail
from edge.tracker.foot.zupt.level_walking import apply_level_constraint, is_due
from edge.tracker.foot.zupt.stance_acceptance import (
    is_accepted,
    note_restlessness,
    note_stillness,
    remember_stance,
)
from edge.tracker.foot.zupt.stance_consistency import begin_stance, inflate_for_misfit
from edge.tracker.foot.zupt.stance_detection import stance_threshold, steady_rate, unrest
from edge.tracker.foot.zupt.stance_revision import (
    note_correction,
    propagate_correction,
    weigh_stance,
)
from edge.tracker.foot.zupt.zupt import apply_zupt, is_gliding
from edge.tracker.foot.zupt.zupt_residuals import on_footfall, on_lift_off, strike_share
from edge.tracker.mechanization.strapdown import dot, rotation_matrix
from edge.tracker.preprocessing.preprocess import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring, reach
from edge.tracker.preprocessing.sample_times import lacks_samples
from edge.tracker.preprocessing.saturation_detection import ACCEL_SATURATED, GYRO_SATURATED

MIN_STRIDE_M = 0.15  # a smaller move is a shuffle: it counts with the next


@njit()
def filter_sample(
    ring: Ring, trail: Trail, progress: Progress, state: FilterState, k: int, config: EskfConfig
) -> None:
    """Take sample ``k`` of the ring into ``state``; write its row and its step of the trail."""
    slot = k & (len(ring) - 1)
    step = trail[k & (len(trail) - 1)]
    step.updates = 0
    if ring[slot].flags & GYRO_SATURATED:
        stop = min(progress.measured, reach(ring, k))
        recover_rates(ring, state.bridge, k, stop, config)
    if ring[slot].flags & ACCEL_SATURATED:
        recover_forces(ring, k, min(progress.measured, reach(ring, k)), config)
    good = ring[slot].flags & BAD_SAMPLES == 0
    open_s = open_gap_s(ring, progress, slot, good, config)
    if k == 0:
        _start(ring, progress, state, config)
    else:
        _predict(ring, step, progress, state, k, config)
    update_temperature_bias(ring, step, progress, state, slot, config)
    motion = ring[slot].motion_m2ps4
    still = good and motion <= stance_threshold(ring, state, slot, config)
    still = still and not is_gliding(ring, progress, state, k, config)
    note_restlessness(ring, progress, slot, config)
    if still and not progress.in_stance:
        still = is_accepted(ring, progress, state, k, config)
    if still:
        ring[slot].unrest_m2ps4 = unrest(ring, progress, state, k, config)
        learn_from_stance(progress, state, config)
        if not progress.in_stance:
            begin_stance(ring, step, progress, state, slot, config)
            weigh_stance(progress, state, ring[slot].t_s, config)
            on_footfall(ring, step, state, slot, config)
        note_stillness(progress, motion)
        apply_zupt(ring, step, state, slot, config)
        note_correction(state, ring[slot].t_s, config)
        inflate_for_misfit(progress, state, ring[slot].t_s, config)
        add_hidden_turn(state, config)
        _end_swing(state)
        if not state.barometer.riding and is_due(ring, progress, k, config):
            apply_level_constraint(ring, step, progress, state, slot, config)
    elif progress.in_stance:
        on_lift_off(state, config)
        remember_stance(progress, config)
        accept_heading(state)
    inflate_bias(state, config)
    update_magnetometer(ring, step, state, slot, still, config)
    update_barometer(ring, step, progress, state, slot, still, config)
    if note_faults(ring, progress, slot):
        state.faulty_stride = True
    _count_steps(progress, state, still, ring[slot].t_s)
    _write_row(ring, progress, state, slot, still)
    report_covariance(ring, step, state, slot, open_s, config)
    assign_quality(ring, progress, state, slot, open_s, config)


@njit()
def _start(ring: Ring, progress: Progress, state: FilterState, config: EskfConfig) -> None:
    stop = min(progress.measured, reach(ring, 0))
    ahead_s = config.timing.lookahead_s + config.timing.lag_s
    tilt_std_rad = level(ring, 0, stop, ahead_s, config, state.quaternion_nb)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    moving = ring[0].motion_m2ps4 > config.detection.threshold_min_m2ps4
    speed_std_mps = config.start.speed_std_mps if moving else config.start.still_std_mps
    rest_rate_radps = steady_rate(ring, 0, stop, ahead_s, config)
    for i in range(3):
        state.covariance[VELOCITY + i, VELOCITY + i] = speed_std_mps**2
        bias_std_radps = config.start.gyro_bias_std_radps
        if abs(rest_rate_radps[i]) > config.start.gyro_bias_gate * bias_std_radps:
            bias_std_radps = abs(rest_rate_radps[i])  # a rest shows more than was to be expected
        state.covariance[GYRO_BIAS + i, GYRO_BIAS + i] = bias_std_radps**2
        state.covariance[ACCEL_BIAS + i, ACCEL_BIAS + i] = config.start.accel_bias_std_mps2**2
        state.covariance[LEVER + i, LEVER + i] = config.start.lever_std_m**2
        state.covariance[GYRO_BIAS_PER_K + i, GYRO_BIAS_PER_K + i] = (
            config.process.gyro_bias_per_k_std_radps**2
        )
    # The heading at the start is the frame's own and therefore known.
    state.covariance[ATTITUDE, ATTITUDE] = tilt_std_rad**2
    state.covariance[ATTITUDE + 1, ATTITUDE + 1] = tilt_std_rad**2
    for i in range(3):
        state.rest_force_mps2[i] = ring[0].accel_mps2[i]
        state.scale_errors.down_b[i] = state.rotation_nb[2, i]
        state.least_known_axis_b[i] = state.rotation_nb[2, i]
    state.mean_zupt_residual = config.residuals.mean_zupt_residual
    state.mean_scale_residual = config.residuals.mean_zupt_residual
    state.mean_gain_residual = config.residuals.mean_zupt_residual
    state.gain_residual = config.residuals.mean_zupt_residual
    state.mean_strike_residual = config.residuals.mean_strike_residual
    start_bridges(state, config)
    progress.last_stance_s = ring[0].t_s


@njit()
def _predict(
    ring: Ring, step: Step, progress: Progress, state: FilterState, k: int, config: EskfConfig
) -> None:
    mask = len(ring) - 1
    slot = k & mask
    before = (k - 1) & mask
    dt_s = ring[slot].t_s - ring[before].t_s
    ring[slot].interval_s = 0.0
    if k == progress.began_at:  # nothing is known of the motion before it
        ring[slot].interval_s = -1.0
        reinitialise(ring, progress, state, k, dt_s, config)
        return
    if dt_s == 0.0:
        return
    mean_readings(ring, progress, state, k, config)
    lost_s = unstamped_loss_s(ring, progress, k, config)
    if lost_s > 0.0:
        hold_readings(ring, state, slot, config)
        dt_s += lost_s
        ring[slot].flags |= SAMPLE_GAP
        state.faulty_stride = True
    if progress.similar_count:
        propagate_through_gap(ring, progress, state, k, dt_s, config)
    else:
        integrate(state, dt_s, config)
    propagate(state, dt_s)
    propagate_clone(state, dt_s)
    propagate_correction(state, dt_s)
    rotate_state(state, propagate_scale_errors(state, dt_s, config))
    accumulate_heading_bias(state, dt_s, config)
    propagate_hidden_turn(state, dt_s)
    propagate_gap_turn(state, dt_s)
    state.swing_rad += dt_s * math.sqrt(dot(state.gyro_radps, state.gyro_radps))
    speed_mps = math.sqrt(dot(state.velocity_n_mps, state.velocity_n_mps))
    level_mps = math.sqrt(state.velocity_n_mps[0] ** 2 + state.velocity_n_mps[1] ** 2)
    state.swing_speed_mps = max(state.swing_speed_mps, speed_mps)
    state.swing_level_speed_mps = max(state.swing_level_speed_mps, level_mps)
    _add_noise(ring, progress, state, k, dt_s, config)
    if lost_s > 0.0:
        inflate_for_loss(state, lost_s, config)
    elif lacks_samples(ring, slot, dt_s):
        state.faulty_stride = True
        inflate_for_gap(ring, progress, state, k, dt_s, config)
    ring[slot].interval_s = dt_s
    for i in range(3):
        step.force_n_mps2[i] = state.force_n_mps2[i]
        for j in range(3):
            step.rotation_nb[i, j] = state.rotation_nb[i, j]


@njit()
def _add_noise(
    ring: Ring, progress: Progress, state: FilterState, k: int, dt_s: float, config: EskfConfig
) -> None:
    """Add process noise of one interval: sensor noise, hidden parts of saturated samples, random
    walks of the biases.
    """
    slot, before = k & (len(ring) - 1), (k - 1) & (len(ring) - 1)
    gyro_noise = config.process.gyro_noise_radps_rthz**2
    accel_noise = config.process.accel_noise_mps2_rthz**2
    if (ring[slot].flags | ring[before].flags) & ACCEL_SATURATED:
        for axis in range(3):
            hidden = ring[slot].hidden_force_noise[axis] + ring[before].hidden_force_noise[axis]
            _inflate_axis(state, VELOCITY, axis, 0.5 * dt_s * hidden)
    unseen = config.process.curvature_noise_per_strike * state.mean_strike_residual
    strike_noise = dt_s * unseen**2 * state.force_curvature_var
    state.faultless_var_m2ps2 += dt_s * (accel_noise + strike_noise)
    accel_noise += strike_noise * strike_share(state)
    gyro_noise += dt_s * state.gyro_curvature_var
    if ring[slot].flags & GYRO_SATURATED:
        for axis in range(3):
            variance = dt_s * ring[slot].hidden_noise[axis]
            propagate_bridge(state, axis, dt_s * ring[slot].bridge_radps[axis])
            _inflate_axis(state, ATTITUDE, axis, variance)
            state.swing_hidden_rad2 += state.rotation_nb[2, axis] ** 2 * variance
    temperature_known = math.isfinite(progress.temperature_degc)
    bias_walk = (
        config.process.gyro_bias_walk_known_temperature_radps2_rthz
        if temperature_known
        else config.process.gyro_bias_walk_radps2_rthz
    )
    for i in range(3):
        state.covariance[VELOCITY + i, VELOCITY + i] += dt_s * accel_noise
        state.covariance[ATTITUDE + i, ATTITUDE + i] += dt_s * gyro_noise
        state.covariance[GYRO_BIAS + i, GYRO_BIAS + i] += dt_s * bias_walk**2
        state.covariance[ACCEL_BIAS + i, ACCEL_BIAS + i] += (
            dt_s * config.process.accel_bias_walk_mps3_rthz**2
        )


@njit()
def _inflate_axis(state: FilterState, errors: int, axis: int, variance: float) -> None:
    """Add variance to three errors in navigation axes, along or about one axis of the sensor."""
    rotation = state.rotation_nb
    for i in range(3):
        for j in range(3):
            state.covariance[errors + i, errors + j] += (
                rotation[i, axis] * rotation[j, axis] * variance
            )


@njit()
def _end_swing(state: FilterState) -> None:
    state.swing_rad = 0.0
    state.faultless_var_m2ps2 = 0.0
    state.swing_speed_mps = 0.0
    state.swing_level_speed_mps = 0.0


@njit()
def _count_steps(progress: Progress, state: FilterState, still: bool, t_s: float) -> None:
    if still and not progress.in_stance:
        progress.stance_since_s = t_s
        north_m = state.position_n_m[0] - progress.foothold_north_m
        east_m = state.position_n_m[1] - progress.foothold_east_m
        moved_m = math.sqrt(north_m * north_m + east_m * east_m)
        if moved_m > MIN_STRIDE_M:
            progress.steps += 1
            progress.distance_m += moved_m
            progress.foothold_north_m = state.position_n_m[0]
            progress.foothold_east_m = state.position_n_m[1]
    if still:
        progress.last_stance_s = t_s
    progress.in_stance = still


@njit()
def _write_row(ring: Ring, progress: Progress, state: FilterState, slot: int, still: bool) -> None:
    for i in range(3):
        ring[slot].position_n_m[i] = state.position_n_m[i]
        ring[slot].velocity_n_mps[i] = state.velocity_n_mps[i]
    for i in range(4):
        ring[slot].quaternion_nb[i] = state.quaternion_nb[i]
    ring[slot].stationary = still
    ring[slot].distance_m = progress.distance_m
    ring[slot].steps = progress.steps
