"""Model of the magnetic field around a walk: one hypothesis of how steel distorts it.

The field of a stance, turned into navigation axes by the tracker's attitude ``R``, is

    R m = f + R h + near + wide + d (f x down)

``f`` is the earth's field in the frame of the walk, the same everywhere; ``h`` is the iron on the
foot, the same in sensor axes, and separated from ``f`` by turning about; ``near`` and ``wide`` are
the distortion by steel, forgotten within a stride or two and within a room (all in uT); ``d`` is
the error of heading (rad).  Only the horizontal component across ``f`` observes ``d``.  The other
two, along and vertical, show how distorted the field is just here, and that is the uncertainty of
the one across.  Declination, strength and dip are not assumed.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.aiding.aiding_filter import measure, project
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import COMPASS_SIZE, Aid

FIELD, IRON, NEAR, WIDE = 1, 4, 7, 10  # three states each, after the error of heading
ALONG, VERTICAL, ACROSS = 0, 1, 2
UNKNOWN_HEADING_VAR_RAD2 = math.pi**2 / 3.0  # variance of a heading of which nothing is known


@njit()
def start_hypothesis(
    hypothesis: Aid, wide_std_ut: float, iron_std_ut: float, config: EskfConfig
) -> None:
    """Begin a hypothesis: the wide distortion has this standard deviation."""
    hypothesis.wide_var_ut2 = wide_std_ut**2
    hypothesis.distortion_var_ut2 = config.field.distortion_start_ut**2
    for i in range(3):
        hypothesis.covariance[FIELD + i, FIELD + i] = config.field.std_ut**2
        hypothesis.covariance[IRON + i, IRON + i] = iron_std_ut**2
        hypothesis.covariance[WIDE + i, WIDE + i] = hypothesis.wide_var_ut2


@njit()
def decay_distortion(hypothesis: Aid, moved_m: float, config: EskfConfig) -> None:
    """Fade the distortion by steel with the distance moved since the last stance."""
    near = math.exp(-moved_m / config.field.near_m)
    wide = math.exp(-moved_m / config.field.wide_m)
    _fade(hypothesis, NEAR, near)
    _fade(hypothesis, WIDE, wide)
    hypothesis.near_renewal = 1.0 - near * near
    hypothesis.wide_renewal = 1.0 - wide * wide


@njit()
def _fade(hypothesis: Aid, first: int, kept: float) -> None:
    for i in range(first, first + 3):
        hypothesis.estimate[i] *= kept
        for j in range(COMPASS_SIZE):
            hypothesis.covariance[i, j] *= kept
        for j in range(COMPASS_SIZE):
            hypothesis.covariance[j, i] *= kept


@njit()
def update_hypothesis(compass: Aid, hypothesis: Aid, config: EskfConfig) -> None:
    """Update by the mean field of a stance; a large innovation makes the hypothesis less likely.

    A stride away the wide bends are almost the same, so each look speaks as far as they are new.
    """
    set_field_direction(hypothesis)
    _update_distortion(compass, hypothesis, config)
    for axis in range(3):
        variance = component_row(compass, hypothesis, axis, config)
        residual = _residual(compass, hypothesis)
        expected = project(hypothesis.covariance, compass.row, compass.column) + variance
        nis = residual * residual / expected
        most = config.aiding.gate**2
        log_penalty = min(nis, most) + math.log(expected)
        hypothesis.log_weight -= 0.5 * hypothesis.wide_renewal * log_penalty
        if nis <= most:
            measure(
                hypothesis.estimate,
                hypothesis.covariance,
                compass.row,
                residual,
                variance,
                compass.column,
            )


@njit()
def _update_distortion(compass: Aid, hypothesis: Aid, config: EskfConfig) -> None:
    """Estimate how distorted the field is here from the components that no heading changes.

    Doubt comes at once and goes slowly.
    """
    distortion_var = hypothesis.distortion_var_ut2
    for axis in (ALONG, VERTICAL):
        expected = component_row(compass, hypothesis, axis, config)
        expected += project(hypothesis.covariance, compass.row, compass.column)
        residual = _residual(compass, hypothesis)
        seen = max(residual * residual - expected, 0.0)
        weight = (
            config.field.distortion_rise if seen > distortion_var else config.field.distortion_fall
        )
        weight *= hypothesis.near_renewal * distortion_var / (distortion_var + expected)
        distortion_var += weight * (seen - distortion_var)
    distortion_var = max(distortion_var, config.field.distortion_floor_ut**2)
    hypothesis.distortion_var_ut2 = distortion_var
    for i in range(3):
        hypothesis.covariance[NEAR + i, NEAR + i] += hypothesis.near_renewal * distortion_var
        hypothesis.covariance[WIDE + i, WIDE + i] += (
            hypothesis.wide_renewal * hypothesis.wide_var_ut2
        )


@njit()
def set_field_direction(hypothesis: Aid) -> None:
    """Set the horizontal direction of ``f``; north where it is unknown."""
    north, east = hypothesis.estimate[FIELD], hypothesis.estimate[FIELD + 1]
    strength = math.sqrt(north * north + east * east)
    hypothesis.strength_ut = strength
    hypothesis.field_direction_n[0] = north / strength if strength > 0.0 else 1.0
    hypothesis.field_direction_n[1] = east / strength if strength > 0.0 else 0.0


@njit()
def is_field_known(hypothesis: Aid, config: EskfConfig) -> bool:
    """True when the horizontal field is large against its standard deviation."""
    spread = hypothesis.covariance[FIELD, FIELD] + hypothesis.covariance[FIELD + 1, FIELD + 1]
    return bool(hypothesis.strength_ut**2 > config.field.known_ratio**2 * spread)


@njit()
def component_row(compass: Aid, hypothesis: Aid, axis: int, config: EskfConfig) -> float:
    """Write the measurement row of one component; return the variance that is its own.

    That includes what the linear model leaves out: the product of the errors of heading and
    of ``f``, and that sine and cosine are no straight lines.
    """
    ahead, right = hypothesis.field_direction_n[0], hypothesis.field_direction_n[1]
    heading_var = hypothesis.covariance[0, 0]
    strength = hypothesis.strength_ut
    variance = config.field.noise_ut**2
    sensitivity = 0.0
    if axis == ALONG:
        x, y, z = ahead, right, 0.0
        variance += 0.5 * (heading_var * strength) ** 2
    elif axis == VERTICAL:
        x, y, z = 0.0, 0.0, 1.0
    else:
        x, y, z = -right, ahead, 0.0
        spread = hypothesis.covariance[FIELD, FIELD] + hypothesis.covariance[FIELD + 1, FIELD + 1]
        variance += heading_var * spread
        distortion_ratio = hypothesis.distortion_var_ut2 / max(strength * strength, 1.0)
        variance += (
            hypothesis.distortion_var_ut2 * distortion_ratio / config.field.distortion_ratio**2
        )
        if (
            is_field_known(hypothesis, config)
            and distortion_ratio < config.field.distortion_limit**2
        ):
            sensitivity = -strength
            variance += heading_var**3 * strength**2 * 5.0 / 12.0
        else:
            variance += heading_var * strength**2
    row, rotation = compass.row, compass.rotation_nb
    for first in (FIELD, NEAR, WIDE):
        row[first], row[first + 1], row[first + 2] = x, y, z
    for i in range(3):
        row[IRON + i] = x * rotation[0, i] + y * rotation[1, i] + z * rotation[2, i]
    row[0] = sensitivity
    return float(variance)


@njit()
def _residual(compass: Aid, hypothesis: Aid) -> float:
    """Return the measured component beyond the one expected, for the row just written."""
    seen = 0.0
    for i in range(3):
        seen += compass.row[FIELD + i] * compass.field_n_ut[i]
    for i in range(COMPASS_SIZE):
        seen -= compass.row[i] * hypothesis.estimate[i]
    return float(seen)


@njit()
def north_of(hypothesis: Aid) -> float:
    """Return where magnetic north lies in the frame as the main filter has it now."""
    return float(
        math.atan2(hypothesis.field_direction_n[1], hypothesis.field_direction_n[0])
        - hypothesis.estimate[0]
    )


@njit()
def north_variance(compass: Aid, hypothesis: Aid, earth_known: bool, config: EskfConfig) -> float:
    """Return the variance (rad^2) of ``north_of``, infinite among heavy steel.

    The frame is the walk's, turned by the error of heading, and both are known together.  To
    what the model knows is added what it cannot: a field that is bent alike all over, which
    shows, where the earth's is known, by strength and dip.  These are two components, too few
    to take their mean for all there is of the third, so its variance is their sum.
    """
    limit_ut = config.field.distortion_limit * hypothesis.strength_ut
    if hypothesis.distortion_var_ut2 > limit_ut * limit_ut:
        return math.inf
    p = hypothesis.covariance
    ahead, right, strength = (
        hypothesis.field_direction_n[0],
        hypothesis.field_direction_n[1],
        hypothesis.strength_ut,
    )
    across_var = right * right * p[FIELD, FIELD] + ahead * ahead * p[FIELD + 1, FIELD + 1]
    across_var -= 2.0 * right * ahead * p[FIELD, FIELD + 1]
    with_heading = ahead * p[FIELD + 1, 0] - right * p[FIELD, 0]
    uniform_var = config.field.uniform_ut**2
    if earth_known:
        along_ut, down_ut = _difference_from_earth_ut(compass, hypothesis)
        uniform_var = config.field.matching_ut**2 + along_ut * along_ut + down_ut * down_ut
    variance = (across_var + uniform_var) / max(strength * strength, 1.0)
    variance += p[0, 0] - 2.0 * with_heading / max(strength, 1.0)
    return float(min(variance, UNKNOWN_HEADING_VAR_RAD2))


@njit()
def earth_log_likelihood(compass: Aid, hypothesis: Aid, config: EskfConfig) -> float:
    """Return the log-likelihood of strength and dip under this hypothesis, given the earth's field.

    Their differences from the earth's have the variance of the distortion.
    """
    p = hypothesis.covariance
    ahead, right = hypothesis.field_direction_n[0], hypothesis.field_direction_n[1]
    along_ut, down_ut = _difference_from_earth_ut(compass, hypothesis)
    along_var = ahead * ahead * p[FIELD, FIELD] + right * right * p[FIELD + 1, FIELD + 1]
    along_var += 2.0 * ahead * right * p[FIELD, FIELD + 1] + config.field.matching_ut**2
    down_var = p[FIELD + 2, FIELD + 2] + config.field.matching_ut**2
    nis = along_ut * along_ut / along_var + down_ut * down_ut / down_var
    return float(-0.5 * (nis + math.log(along_var * down_var)))


@njit()
def _difference_from_earth_ut(compass: Aid, hypothesis: Aid) -> tuple[float, float]:
    """Return how far the field of the walk is off the earth's, along it and down."""
    along_ut = hypothesis.strength_ut - compass.earth_horizontal_ut
    return along_ut, hypothesis.estimate[FIELD + 2] - compass.earth_down_ut
