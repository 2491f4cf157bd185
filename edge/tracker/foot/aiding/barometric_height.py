"""Height from air pressure: lifts, ramps, and slow drift of the inertial height.

Once a stance its mean pressure, as a height (isothermal atmosphere, scale height 8434 m), is
compared with the tracker's height.  The difference is the tracker's error and the barometer's own:
weather and warming make that a random walk, which is estimated beside.  Strides on a level floor
are better than any barometer, so by itself it moves little.  It counts where strides are blind:

- In a lift the foot stands and yet rises.  A push of the floor opens the height to the
  barometer until the ride is over; a lift's floor pushes as it starts and as it stops.
- On a gentle ramp the level constraint (level_walking.py) would flatten every stride.  Where the
  barometer shows, stance after stance, that heights are held back, the constraint is suspended.

A door that slams is an outlier, and a fan that raises the pressure for good is a step of the
barometer's own, since no push came before it.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.aiding.aiding_filter import equivalent_measurement, project, sync_variance
from edge.tracker.foot.aiding.aiding_filter import measure as measure_aside
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import POSITION
from edge.tracker.foot.filter.measurement_update import begin_updates, end_updates, measure
from edge.tracker.foot.state import Aid, FilterState, Progress, Step
from edge.tracker.preprocessing.sample_ring import Ring

DOWN = POSITION + 2
OFFSET = 1  # the barometer's own error, after that of the tracker's height
AIR_SCALE_HEIGHT_M = 8434.0  # isothermal air at 15 degC
THINNEST_PA, DENSEST_PA = 3e4, 1.2e5  # readings beyond these are no pressure on foot


@njit()
def update_barometer(
    ring: Ring,
    step: Step,
    progress: Progress,
    state: FilterState,
    slot: int,
    still: bool,
    config: EskfConfig,
) -> None:
    """Accumulate the pressure of a stance; update when the stance ends, or once a second."""
    barometer = state.barometer
    if still:
        _accumulate(ring, state, slot, config)
    if barometer.samples == 0:
        return
    lasted_s = ring[slot].t_s - barometer.since_s
    update_s = config.air.ride_update_s if barometer.riding else config.aiding.update_s
    if still and lasted_s < update_s:
        return
    if lasted_s >= config.aiding.stance_s:
        _update(ring, step, progress, state, slot, lasted_s, config)
    barometer.samples = 0


@njit()
def _accumulate(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> None:
    barometer = state.barometer
    pressure_pa = ring[slot].pressure_pa
    if not THINNEST_PA < pressure_pa < DENSEST_PA or ring[slot].interval_s <= 0.0:
        return  # also when it is not a number, and where no force is known
    if not barometer.started:
        _start(barometer, pressure_pa, ring[slot].t_s)
    if pressure_pa != barometer.last_pa:
        barometer.last_pa = pressure_pa
        barometer.changed_s = ring[slot].t_s
    elif ring[slot].t_s - barometer.changed_s > config.air.stuck_s:
        return
    if barometer.samples == 0:
        barometer.since_s = ring[slot].t_s
        barometer.off_m = 0.0
        barometer.force_mps2 = 0.0
    barometer.samples += 1
    share = 1.0 / barometer.samples
    down_m = AIR_SCALE_HEIGHT_M * math.log(pressure_pa / barometer.reference_pa)
    off_m = down_m - state.position_n_m[2]
    barometer.off_m += share * (off_m - barometer.off_m)
    x, y, z = ring[slot].accel_mps2[0], ring[slot].accel_mps2[1], ring[slot].accel_mps2[2]
    barometer.force_mps2 += share * (math.sqrt(x * x + y * y + z * z) - barometer.force_mps2)


@njit()
def _start(barometer: Aid, pressure_pa: float, t_s: float) -> None:
    barometer.started = True
    barometer.reference_pa = pressure_pa
    barometer.last_pa = pressure_pa
    barometer.changed_s = -math.inf  # not used until it has changed once: a stuck sensor never does
    barometer.updated_s = t_s
    barometer.row[0], barometer.row[OFFSET] = 1.0, 1.0
    barometer.covariance[OFFSET, OFFSET] = 1e6


@njit()
def _update(
    ring: Ring,
    step: Step,
    progress: Progress,
    state: FilterState,
    slot: int,
    lasted_s: float,
    config: EskfConfig,
) -> None:
    barometer = state.barometer
    since_s = ring[slot].t_s - barometer.updated_s
    barometer.updated_s = ring[slot].t_s
    if _detect_ride(barometer, progress, lasted_s, ring[slot].t_s, config):
        state.covariance[DOWN, DOWN] += (config.air.ride_speed_mps * since_s) ** 2
    prior = state.covariance[DOWN, DOWN]
    held = progress.on_floor and not barometer.riding
    # On a floor the error is the floor's: it does not come and go with every swing.
    sync_variance(barometer.covariance, min(prior, progress.level_variance_m2) if held else prior)
    barometer.covariance[OFFSET, OFFSET] += config.air.drift_m_rts**2 * since_s
    residual_m = barometer.off_m - barometer.estimate[0] - barometer.estimate[OFFSET]
    noise = max(barometer.noise_var_m2, config.air.noise_m**2)
    expected = project(barometer.covariance, barometer.row, barometer.column) + noise
    if residual_m * residual_m > config.aiding.gate**2 * expected:
        _reject(barometer, residual_m, config)
    else:
        barometer.rejected = 0
        if not barometer.riding:
            _adapt_noise(barometer, residual_m, expected - noise, config)
            _check_level_constraint(barometer, progress, residual_m, config)
        measure_aside(
            barometer.estimate,
            barometer.covariance,
            barometer.row,
            residual_m,
            noise,
            barometer.column,
        )
        _update_height(step, progress, state, ring[slot].t_s, prior, config)
    if barometer.riding:
        # Until the next look.
        state.covariance[DOWN, DOWN] += (config.air.ride_speed_mps * config.air.ride_update_s) ** 2
        progress.level_variance_m2 = state.covariance[DOWN, DOWN]


@njit()
def _update_height(
    step: Step, progress: Progress, state: FilterState, t_s: float, prior: float, config: EskfConfig
) -> None:
    """Bring the height to what is known now, and the floor that is walked on with it."""
    barometer = state.barometer
    residual_m, variance = equivalent_measurement(barometer.estimate, barometer.covariance, prior)
    if not variance < math.inf:
        return
    before_m = state.position_n_m[2]
    begin_updates(state)
    measure(step, state, DOWN, residual_m, variance)
    end_updates(state)
    moved_m = state.position_n_m[2] - before_m
    if barometer.riding and abs(moved_m) > config.air.ride_going_m:
        barometer.last_motion_s = t_s
    progress.level_m += moved_m
    progress.footfall_n_m[2] += moved_m
    progress.level_variance_m2 = min(progress.level_variance_m2, state.covariance[DOWN, DOWN])


@njit()
def _detect_ride(
    barometer: Aid, progress: Progress, lasted_s: float, t_s: float, config: EskfConfig
) -> bool:
    """Detect the start of a lift ride by a push on a standing person; a stride is its end.

    The accelerometer's own reading at rest is the measure, learned slowly: a push lasts long
    enough to pass for a bias.  Returns whether a ride starts.
    """
    before = barometer.riding
    if lasted_s >= (config.air.ride_update_s if before else config.aiding.update_s):
        if barometer.rest_mps2 == 0.0:
            barometer.rest_mps2 = barometer.force_mps2
        push_mps2 = barometer.force_mps2 - barometer.rest_mps2
        if abs(push_mps2) > config.air.ride_push_mps2:
            barometer.riding = True
            barometer.last_motion_s = t_s
        elif not before:
            barometer.rest_mps2 += config.air.ride_rest_weight * push_mps2
    calm = t_s - barometer.last_motion_s > config.air.ride_calm_s
    if progress.steps != barometer.steps and calm:
        barometer.riding = False
    barometer.steps = progress.steps
    if t_s - barometer.last_motion_s > config.air.ride_longest_s:
        barometer.riding = False
    return bool(barometer.riding and not before)


@njit()
def _adapt_noise(barometer: Aid, residual_m: float, expected_m2: float, config: EskfConfig) -> None:
    """Follow wind and ventilation: up at once, down slowly."""
    known = max(barometer.noise_var_m2, config.air.noise_m**2)
    seen = max(residual_m * residual_m - expected_m2, 0.0)
    weight = config.air.noise_rise if seen > known else config.air.noise_fall
    barometer.noise_var_m2 = known + weight * (seen - known)


@njit()
def _reject(barometer: Aid, residual_m: float, config: EskfConfig) -> None:
    """Leave out a door that slams; take what stays for a step of the pressure."""
    barometer.rejected += 1
    if barometer.rejected > config.air.outliers:
        barometer.rejected = 0
        barometer.estimate[OFFSET] += residual_m
        barometer.covariance[OFFSET, OFFSET] += residual_m * residual_m


@njit()
def _check_level_constraint(
    barometer: Aid, progress: Progress, residual_m: float, config: EskfConfig
) -> None:
    """Suspend the level constraint while the pressure shows, stance after stance, that the floor is
    not level.
    """
    if progress.steps == barometer.checked_at_steps:
        return
    barometer.checked_at_steps = progress.steps
    barometer.mean_off_m += (residual_m - barometer.mean_off_m) / config.air.floor_strides
    if abs(barometer.mean_off_m) > config.air.floor_off_m:
        if (
            not progress.level_constraint_suspended
            and barometer.mean_off_m * progress.withheld_m > 0.0
        ):
            progress.withheld_m = 0.0  # the air denies it
        progress.level_constraint_suspended = True
    elif abs(progress.mean_sink_m) < config.air.floor_sink_m:
        progress.level_constraint_suspended = False
