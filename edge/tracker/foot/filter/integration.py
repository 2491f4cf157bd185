"""Mean rate and mean force over the interval between two samples, and their integration.

A foot turns by several degrees within an interval of a slow sensor.  Two effects count there:
readings bend between samples, so the means are taken over the cubic through two samples before and
two after (one or two may be missing between any of them), and the axis of rotation moves (coning
and sculling, for readings that change evenly; Savage, "Strapdown inertial navigation integration
algorithm design", 1998).

The difference of the cubic from the straight line shows how much the foot may have turned unseen
between the samples.  For the force it is the difference of a quintic through three samples before
and three after from the cubic: next to nothing where the samples follow the motion, and much at a
heel strike that is over within some milliseconds.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.mechanization.strapdown import advance
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.preprocessing.sample_times import lacks_samples

EVEN_SPACING = (0.7, 1.4)  # spacings so alike are the same, for stamps jitter more than sensors do
SPACING_MIN_PERIODS = 0.6  # periods; stamps that are nearer are wrong
QUINTIC_SHARE = 11.0 / 1440.0  # of the quintic through six


@njit()
def mean_readings(
    ring: Ring, progress: Progress, state: FilterState, k: int, config: EskfConfig
) -> None:
    """Write mean rate and force, sensor axes, free of bias, of the interval ending at ``k``.

    ``gyro_curvature_var`` becomes the square of what the cubic has added, ``force_curvature_var``
    that of what a quintic would add to it.
    """
    mask = len(ring) - 1
    last, first = k & mask, (k - 1) & mask
    dt_s = ring[last].t_s - ring[first].t_s
    rise, turn, fall = _cubic_weights(ring, progress, k, dt_s)
    scale = accel_scale(ring[last].rest_norm_mps2, config)
    before, after = (k - 2) & mask, (k + 1) & mask
    state.gyro_curvature_var = 0.0
    even = rise > 0.0 and turn == 0.0
    state.force_curvature_var = _force_curvature_var(ring, progress, k) if even else 0.0
    for i in range(3):
        f0, f1 = ring[before].gyro_radps[i], ring[first].gyro_radps[i]
        f2, f3 = ring[last].gyro_radps[i], ring[after].gyro_radps[i]
        added = rise * (f1 - f0) + turn * (f2 - f1) - fall * (f3 - f2)
        state.gyro_curvature_var += added * added
        state.gyro_radps[i] = 0.5 * (f1 + f2) + added - state.gyro_bias_radps[i]
        f0, f1 = ring[before].accel_mps2[i], ring[first].accel_mps2[i]
        f2, f3 = ring[last].accel_mps2[i], ring[after].accel_mps2[i]
        added = rise * (f1 - f0) + turn * (f2 - f1) - fall * (f3 - f2)
        state.accel_mps2[i] = scale * (0.5 * (f1 + f2) + added) - state.accel_bias_mps2[i]
    rate, rate_after = ring[first].gyro_radps, ring[last].gyro_radps
    force, force_after = ring[first].accel_mps2, ring[last].accel_mps2
    _add_cross(state.gyro_radps, rate, rate_after, dt_s / 12.0)
    _add_cross(state.accel_mps2, rate, force_after, scale * dt_s / 12.0)
    _add_cross(state.accel_mps2, force, rate_after, scale * dt_s / 12.0)


@njit()
def accel_scale(rest_norm_mps2: float, config: EskfConfig) -> float:
    """Return the factor that puts the accelerometer's scale right as far as rest shows it."""
    off_mps2 = rest_norm_mps2 - config.gravity_mps2
    if abs(off_mps2) <= config.detection.rest_bias_mps2:
        return 1.0
    side = 1.0 if off_mps2 > 0.0 else -1.0
    return config.gravity_mps2 / (rest_norm_mps2 - side * config.detection.rest_bias_mps2)


@njit()
def _cubic_weights(
    ring: Ring, progress: Progress, k: int, dt_s: float
) -> tuple[float, float, float]:
    """Return what the cubic's mean adds to the straight line's for each unit of three differences.

    Those are of the readings before, across and (subtracted) after the interval.  All are 0 where
    the outer samples are missing, or too far away.
    """
    if k < 2 or k + 1 >= progress.measured:
        return 0.0, 0.0, 0.0
    mask = len(ring) - 1
    before_s = ring[(k - 1) & mask].t_s - ring[(k - 2) & mask].t_s
    after_s = ring[(k + 1) & mask].t_s - ring[k & mask].t_s
    shortest_s, longest_s = min(before_s, after_s), max(before_s, after_s)
    if EVEN_SPACING[0] * dt_s < shortest_s and longest_s < EVEN_SPACING[1] * dt_s:
        return 1.0 / 24.0, 0.0, 1.0 / 24.0
    too_near = min(shortest_s, dt_s) < SPACING_MIN_PERIODS * ring[k & mask].period_s
    if too_near or lacks_samples(ring, k & mask, max(longest_s, dt_s)):
        return 0.0, 0.0, 0.0
    # Half of the interval squared by twelve, times the cubic's second derivative in its middle.
    whole_s = before_s + dt_s + after_s
    early = dt_s**2 / 6.0 * (after_s + 0.5 * dt_s) / (whole_s * (before_s + dt_s))
    late = dt_s**2 / 6.0 * (before_s + 0.5 * dt_s) / (whole_s * (dt_s + after_s))
    return early / before_s, (late - early) / dt_s, late / after_s


@njit()
def _force_curvature_var(ring: Ring, progress: Progress, k: int) -> float:
    """Return the square of what a quintic adds to the cubic's mean force; 0 at either end."""
    if k < 3 or k + 2 >= progress.measured:
        return 0.0
    mask = len(ring) - 1
    squares = 0.0
    for i in range(3):
        inner = ring[(k - 1) & mask].accel_mps2[i] + ring[k & mask].accel_mps2[i]
        middle = ring[(k - 2) & mask].accel_mps2[i] + ring[(k + 1) & mask].accel_mps2[i]
        outer = ring[(k - 3) & mask].accel_mps2[i] + ring[(k + 2) & mask].accel_mps2[i]
        added = QUINTIC_SHARE * (2.0 * inner - 3.0 * middle + outer)
        squares += added * added
    return squares


@njit()
def _add_cross(total: Floats, a: Floats, b: Floats, weight: float) -> None:
    """Add ``weight`` times ``a x b``."""
    total[0] += weight * (a[1] * b[2] - a[2] * b[1])
    total[1] += weight * (a[2] * b[0] - a[0] * b[2])
    total[2] += weight * (a[0] * b[1] - a[1] * b[0])


@njit()
def integrate(state: FilterState, dt_s: float, config: EskfConfig) -> None:
    """Move position, velocity and attitude by the mean readings of an interval."""
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
