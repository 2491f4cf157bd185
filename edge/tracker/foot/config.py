"""Every parameter of the default tracker, in one place, by the stage that it belongs to, with its
unit.

``rthz`` marks a noise density: a value per square root of hertz, so that nothing depends on the
sample rate.
"""

from __future__ import annotations

from typing import Any, NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray


class TimingConfig(NamedTuple):
    """Times of samples and rows; a row is final after lookahead and lag, which are below 1 s."""

    lookahead_s: float = 0.47  # the stance detector sees this far ahead of the filter
    lag_s: float = 0.43  # the smoother corrects this far behind the filter
    stance_release_s: float = 0.1  # in stance, rows are released this often
    late_delivery_s: float = 0.04  # a stamp may be late by this and is put right
    gap_s: float = 0.1  # a longer silence counts as a gap


class StanceDetectionConfig(NamedTuple):
    """Stance detection (``zupt/stance_detection.py``)."""

    half_window_s: float = 0.03
    rate_weight_m2ps2: float = 40.0  # weight of (rad/s)^2 against (m/s^2)^2
    rest_motion_m2ps4: float = 0.05  # below it the norm of the specific force is learned
    rest_rate_radps: float = 0.1  # a mean rate above any gyroscope's bias is no rest
    rest_off_mps2: float = 1.2  # further off is no rest
    rest_weight: float = 0.03  # of one sample
    steady_motion_m2ps4: float = 0.05  # beyond the mean rate; below it that is the gyroscope's bias
    rest_bias_mps2: float = 0.2  # a rest norm further off is the scale's, not a bias
    stride_past_s: float = 0.65
    threshold_ratio: float = 4.0
    threshold_min_m2ps4: float = 0.3  # what a sensor's noise and a standing body's sway may make
    # What a foot on the ground may roll, 7 rad/s, by the weight of the rate; see decision 64.
    threshold_max_m2ps4: float = 2000.0


class StanceAcceptanceConfig(NamedTuple):
    """A stance or a foot in the air (``zupt/stance_acceptance.py``)."""

    stance_pause_s: float = 0.1  # a shorter one did not leave the ground
    stance_pause_mps: float = 0.25  # ... nor did one so slow
    reject_longest_s: float = 5.0  # without a stance
    slow_swing_mps: float = 2.0  # horizontal peak; that of a stride is 2.5 to 5
    unlike_ratio: float = 6.0  # stillness statistic by that of the wearer's stances
    usual_stance_min_m2ps4: float = 0.05  # stiller is sensor noise
    usual_stance_share: float = 0.15  # of a stance that is less still
    rest_down_mps: float = 0.06  # the filter's vertical velocity of a foot that rests
    rest_ahead_s: float = 0.15  # ... for so long
    rest_level_mps: float = 0.2  # along the floor; faster
    rest_moving_ahead_s: float = 0.3  # ... for so long
    lasting_rest_s: float = 0.7  # as still as a stance; no foot in the air is for so long
    sinking_gate: float = 3.0  # deviations of the vertical velocity
    sinking_level_mps: float = 0.3  # a filter that is wrong is wrong along the floor as well
    sinking_mps: float = 0.02  # deviation after a swing: the give of a shoe
    sinking_drift_mps2: float = 0.02  # ... by its duration: tilt and bias of the accelerometer
    sinking_strike_ratio: float = 1.5  # ... by the residual of this wearer's heel strikes


class ZuptConfig(NamedTuple):
    """Pseudo-measurements in stance (``zupt/zupt.py``)."""

    # Variance of the velocity: (base + per_motion * motion) * (motion / stride minimum)^power.
    stance_velocity_mps_rthz: float = 5e-4
    stance_velocity_per_motion: float = 0.001  # m/s/sqrt(Hz) for each m/s^2 of motion
    stance_excess_power: float = 3.0
    stance_excess_floor_m2ps4: float = 0.3  # a smaller stride minimum is sensor noise
    glide_fastest_mps: float = 15.0  # no foot glides or lands faster: then the filter is wrong
    glide_gate: float = 4.0  # deviations of the velocity at which a foot does not stand
    landing_gate: float = 2.0  # ... by which it falls, where it lands soon
    landing_ahead_s: float = 0.15  # a swing is as still as a stance so long before it ends
    landing_rate_share: float = 0.1  # of the statistic of a landing; a lift-off turns the foot
    # Noise density of the rate: base plus per_unrest * unrest^1.5.
    stance_rate_radps_rthz: float = 1e-3
    stance_rate_per_unrest: float = 1.0
    unrest_half_window_s: float = 0.3  # over which the foot must rest to tell the gyroscope bias
    stance_rate_gain_min_hz: float = 0.02  # less of the bias's variance in a second is left out


class StanceConsistencyConfig(NamedTuple):
    """Stances that contradict the motion between them (``zupt/stance_consistency.py``)."""

    nis: float = 30.7  # chi-square with three degrees of freedom: one stance in a million
    single_nis: float = 11.3  # ... one in a hundred: less adds nothing to a series
    memory: float = 0.7  # of the stance before
    height_m: float = 0.75  # a deviation with which 95 % lie within half a storey of 3 m


class StanceRevisionConfig(NamedTuple):
    """A brief stance that the next one contradicts (``zupt/stance_revision.py``)."""

    evidence: float = 11.3  # chi-square with three degrees of freedom: one in a hundred
    memory: float = 0.5  # of the evidence before
    together_nis: float = 11.3  # chi-square with three degrees of freedom: one in a hundred
    longest_stance_s: float = 0.3  # no instant of a swing is as still for longer
    least_doubt: float = 0.1  # of the way that is taken back


class FloorConfig(NamedTuple):
    """The floor (``zupt/level_walking.py``)."""

    gate_m: float = 0.06  # a larger rise of one stride is a stair, a kerb or a ramp
    gate_slope: float = 0.075  # the same by the stride's length, where that is more
    std_m: float = 0.01
    gate_stds: float = 2.0  # the same by how well the filter knows a rise; half of it is ordinary
    ramp_strides: float = 6.0  # whose ordinary rises are exceeded in sum
    ramp_std_ratio: float = 0.5  # deviation of the height by what the floor has taken out of it
    ramp_max_m: float = 1.0  # ... up to this much: no ramp so gentle is longer
    rise_bias_strides: float = 30.0  # over which the habit on the flat is learned
    rise_bias_std_m: float = 0.004  # by which stairs may differ from it
    rise_bias_per_gain_m: float = 1.0  # ... for each unit of what the gains may be off
    pause_s: float = 0.4  # between two looks at the floor


class AidingConfig(NamedTuple):
    """Aids that are looked at once a stance (``aiding/aiding_filter.py``)."""

    stance_s: float = 0.1  # a shorter stance is not looked at
    update_s: float = 1.0  # a longer one is looked at again
    gate: float = 4.0  # standard deviations


class MagneticFieldConfig(NamedTuple):
    """The magnetic field (``aiding/magnetic_field.py``)."""

    std_ut: float = 60.0  # the earth's, before it is seen
    iron_std_ut: float = 40.0  # of iron on the foot
    iron_least_ut: float = 1.0  # ... of a calibrated unit
    noise_ut: float = 0.5  # of the mean of a stance
    near_m: float = 1.5  # steel nearby is forgotten over this way
    wide_m: float = 50.0  # and that of a whole part of a building over this
    wide_ut: float = 0.4  # deviation of that by the first belief
    wide_ratio: float = 2.2  # ... of each that follows by the one before
    least_log_weight: float = -12.0  # of a belief beside the likeliest
    weight_min: float = 0.01  # weight from which a belief is asked where north is
    distortion_start_ut: float = 5.0  # how far steel bends the field, before it is seen
    distortion_floor_ut: float = 0.7
    distortion_rise: float = 0.3  # of one stance that is worse
    distortion_fall: float = 0.04  # ... that is better
    distortion_ratio: float = (
        0.2  # distortion by horizontal field, above which variance grows faster
    )
    distortion_limit: float = 0.5  # ... above which the field gives no heading
    uniform_ut: float = 4.0  # by which it may be bent alike all over
    matching_ut: float = 1.0  # ... though strength and dip are the earth's
    known_ratio: float = 3.0  # horizontal field by its deviation; below it gives no heading


class BarometerConfig(NamedTuple):
    """The air's pressure, and rides in lifts (``aiding/barometric_height.py``)."""

    drift_m_rts: float = 0.025  # random walk a root of second: weather and warming
    noise_m: float = 0.06  # of the mean of a stance, at least
    noise_rise: float = 0.2  # of one look that is worse
    noise_fall: float = 0.05  # ... that is better
    outliers: int = 4  # so many in a row are none: the pressure has changed
    floor_strides: float = 8.0
    floor_off_m: float = 0.07  # mean over so many strides that speaks against a flat floor
    floor_sink_m: float = 0.008  # mean sink of a stride that is none
    ride_push_mps2: float = 0.15  # mean over an update while a person stands
    ride_rest_weight: float = 0.1  # of one look without a push
    ride_motion_m2ps4: float = 1.0  # of a person who stands in a lift, at most
    ride_speed_mps: float = 2.5
    ride_going_m: float = 0.15  # in one look
    ride_calm_s: float = 2.0  # without a push or a rise, before a stride ends it
    ride_update_s: float = 0.25
    stuck_s: float = 2.0  # the same to the last bit for so long is a sensor that hangs
    ride_longest_s: float = 40.0  # after the last push or rise


class ProcessNoiseConfig(NamedTuple):
    """Process noise."""

    accel_noise_mps2_rthz: float = 0.105
    gyro_noise_radps_rthz: float = 1.75e-3
    curvature_noise_per_strike: float = (
        400.0  # noise of the force, per strike residual and curvature
    )
    gyro_bias_per_k_std_radps: float = 1.7e-4  # 0.01 deg/s/K
    temperature_smoothing_s: float = 1.0
    temperature_step_k: float = 0.2  # from so much on the bias follows
    gyro_bias_walk_radps2_rthz: float = 5e-5  # including warming that is not measured
    gyro_bias_walk_known_temperature_radps2_rthz: float = 2e-5  # where the temperature is known
    accel_bias_walk_mps3_rthz: float = 7e-5


class LandingResidualConfig(NamedTuple):
    """Quality of sensor and foot (``zupt/zupt_residuals.py``): velocity for each radian of the
    swing, m/s.
    """

    mean_zupt_residual: float = 0.014  # before any landing
    zupt_residual_prior_count: float = 8.0  # that is worth so many landings
    zupt_residual_memory: float = 40.0  # landings
    zupt_residual_max: float = 0.06  # of one
    mean_strike_residual: float = 0.01  # the same of the vertical velocity, before any landing
    strike_prior_count: float = 2.0
    zupt_residual_bias_std_radps: float = 1e-3  # of the gyroscope; more is no ordinary stride
    zupt_residual_usual: float = 0.025  # of a sensor with the gains of a data sheet
    zupt_residual_quiet: float = 0.012  # of one whose gains are right
    gain_landings: float = 8.0  # that show the gains; before the first a data sheet is reported
    least_gain_std: float = 0.006  # reported of any sensor that is not described; see decision 163
    zupt_residual_speed_mps: float = 5.0  # of the swing; what gains do grows with it beyond
    zupt_residual_slow_mps: float = 2.0  # a slower swing does not show them
    zupt_residual_poor: float = 0.025  # then the noise is what the filter works with


class ClippingConfig(NamedTuple):
    """Motion that clipping hides (``preprocessing/saturation_recovery.py``)."""

    hidden_rate_limit_radps: float = 6.0
    hidden_rate_floor_radps: float = 0.2
    hidden_rate_std_ratio: float = 0.5  # of the bridged peak, scaled
    bridge_scale_std: float = 0.4  # of the scale of bridged peaks, before any landing
    bridge_scale_walk: float = 0.05  # ... by which it changes from one run to the next
    bridge_scale_min: float = 0.1  # more is hidden than nothing
    hidden_turn_share: float = 0.2  # of what a swing may hide of its turn: the same in all
    hidden_force_limit_mps2: float = 300.0
    hidden_force_floor_mps2: float = 5.0
    hidden_force_std_ratio: float = 1.0  # of the bridged peak
    hidden_rise_share: float = 0.5  # of what a clipped stride may hide of its rise: alike in all


class StartConfig(NamedTuple):
    """Knowledge at the start."""

    gyro_bias_std_radps: float = 0.005
    gyro_bias_gate: float = 3.0  # deviations
    rest_rate_scatter: float = 0.25  # of the mean rate; a foot that sways scatters more
    data_sheet_bias_std_radps: float = 0.0175  # stated until a rest shows it: 1 deg/s
    accel_bias_std_mps2: float = 0.3
    lever_std_m: float = 0.1
    data_sheet_gain_std: float = 0.012  # of scale and axes of uncalibrated sensors
    gain_per_force: float = 0.04  # rad/s that a m/s^2 adds, by the gain's error
    tilt_std_rad: float = 0.014
    tilt_per_motion: float = 0.05  # rad for each m/s^2 that the stillest window shows
    speed_std_mps: float = 3.0  # when the recording starts on the move
    still_std_mps: float = 0.02  # when it starts at rest
    window_s: float = 0.1


class GapConfig(NamedTuple):
    """A hole shorter than a stride (``preprocessing/similar_strides.py``,
    ``filter/gap_filling.py``).
    """

    similar_side_s: float = 0.05  # on either side of a hole, by which like strides are found
    similar_apart_s: float = 0.2  # what is nearer is of the same stride
    similar_longest_s: float = 0.35  # hole
    similar_rate_s: float = 17.0  # ... over which all of a rate would be missed, as by noise
    similar_force_s: float = 5.0  # the same of a force
    similar_spread_weight: float = 1.5  # what the variance among like strides counts beside
    bridged_s: float = 0.28  # most of a swing: longer ones only as in like strides
    around_s: float = 0.45  # where rate and force are looked at; no further than lookahead_s
    rate_s: float = 0.07  # for which a rate goes its way
    force_s: float = 0.05  # the same of a force


class UnstampedLossConfig(NamedTuple):
    """Lost samples that the stamps do not show (``preprocessing/unstamped_loss.py``)."""

    field_ut: float = 2.0  # change of the field beyond the expected one, between two samples
    even_ut: float = 0.5  # change before and after, or the foot does not turn
    ratio: float = 1.5  # change by those before and after
    bend_ratio: float = 2.0  # unexpected change by how much those around differ
    longest_s: float = 0.25
    std_share: float = 0.5  # deviation of the duration by itself
    std_s: float = 0.005  # ... and at least
    unseen_ratio: float = 2.0  # way that others hide, by that of losses that are seen


class ReinitialisationConfig(NamedTuple):
    """A longer gap (``filter/reinitialisation.py``)."""

    speed_std_mps: float = 1.5
    turn_std_radps: float = 1.0


class OutputConfig(NamedTuple):
    """Reported covariance and quality (``output/``)."""

    report_floor_m: float = 0.02  # give of a shoe and of a floor
    saturation_ratio: float = 0.985  # of full scale
    no_stance_degraded_s: float = 3.0
    no_stance_lost_s: float = 10.0
    fault_memory_s: float = 2.0  # a fault marks the rows that follow for so long
    degraded_std_m: float = 3.0
    lost_std_m: float = 15.0
    aligned_tilt_std_rad: float = 0.05
    settled_heading_std_rad: float = 0.1


class EskfConfig(NamedTuple):
    """The one default configuration; nothing here is set per recording."""

    gravity_mps2: float = 9.80665
    timing: TimingConfig = TimingConfig()
    detection: StanceDetectionConfig = StanceDetectionConfig()
    acceptance: StanceAcceptanceConfig = StanceAcceptanceConfig()
    zupt: ZuptConfig = ZuptConfig()
    consistency: StanceConsistencyConfig = StanceConsistencyConfig()
    revision: StanceRevisionConfig = StanceRevisionConfig()
    floor: FloorConfig = FloorConfig()
    aiding: AidingConfig = AidingConfig()
    field: MagneticFieldConfig = MagneticFieldConfig()
    air: BarometerConfig = BarometerConfig()
    process: ProcessNoiseConfig = ProcessNoiseConfig()
    residuals: LandingResidualConfig = LandingResidualConfig()
    clipping: ClippingConfig = ClippingConfig()
    start: StartConfig = StartConfig()
    gap: GapConfig = GapConfig()
    loss: UnstampedLossConfig = UnstampedLossConfig()
    restart: ReinitialisationConfig = ReinitialisationConfig()
    output: OutputConfig = OutputConfig()


def _dtype(config: type[Any]) -> np.dtype[Any]:
    """Return the structure of a record with the fields of a NamedTuple, parts within it too."""
    return np.dtype(
        [
            (name, float if kind is float else int if kind is int else _dtype(kind))
            for name, kind in get_type_hints(config).items()
        ]
    )


_PARAMETERS = _dtype(EskfConfig)


def config_record(config: EskfConfig) -> NDArray[Any]:
    """Return one record of the same fields.

    Compiled kernels hand a record on as one pointer, a tuple as every value of it.
    """
    return np.array([tuple(config)], _PARAMETERS)
