"""What the magnetic field around a walk may be like: one belief of how steel bends it.

The field of a stance, turned into navigation axes by the tracker's attitude ``R``, is

    R m = f + R h + near + wide + d (f x down)

``f`` is the earth's field in the frame of the walk, the same wherever one goes; ``h`` is the
iron on the foot, the same in sensor axes, and told from ``f`` by turning about; ``near`` and
``wide`` are what steel does to the field, forgotten within a stride or two and within a
room; ``d`` is the error of heading that is looked for.  Only the horizontal component across
``f`` tells of ``d``.  The other two, along and vertical, tell how bent the field is just
here, and that is how much the one across is doubted.  Nothing is taken for granted of
declination, strength or dip.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.side_filter import measure, project
from edge.tracker.state import COMPASS_SIZE, Aid

FIELD, IRON, NEAR, WIDE = 1, 4, 7, 10  # three states each, after the error of heading
ALONG, VERTICAL, ACROSS = 0, 1, 2
ANYWHERE_RAD2 = math.pi**2 / 3.0  # variance of a heading of which nothing is known


@njit()
def expect(belief: Aid, wide_std_ut: float, iron_std_ut: float, config: EskfConfig) -> None:
    """Begin a belief: the wide bends have this deviation."""
    belief.wide_var_ut2 = wide_std_ut**2
    belief.bend_var_ut2 = config.field_bend_start_ut**2
    for i in range(3):
        belief.covariance[FIELD + i, FIELD + i] = config.field_std_ut**2
        belief.covariance[IRON + i, IRON + i] = iron_std_ut**2
        belief.covariance[WIDE + i, WIDE + i] = belief.wide_var_ut2


@njit()
def leave(belief: Aid, moved_m: float, config: EskfConfig) -> None:
    """Forget what steel did where the foot stood before, as far as it has moved since."""
    near = math.exp(-moved_m / config.field_near_m)
    wide = math.exp(-moved_m / config.field_wide_m)
    _fade(belief, NEAR, near)
    _fade(belief, WIDE, wide)
    belief.near_is_new = 1.0 - near * near
    belief.wide_is_new = 1.0 - wide * wide


@njit()
def _fade(belief: Aid, first: int, kept: float) -> None:
    for i in range(first, first + 3):
        belief.estimate[i] *= kept
        for j in range(COMPASS_SIZE):
            belief.covariance[i, j] *= kept
        for j in range(COMPASS_SIZE):
            belief.covariance[j, i] *= kept


@njit()
def learn(compass: Aid, belief: Aid, config: EskfConfig) -> None:
    """Take the mean field of a stance; what surprises makes the belief less likely.

    A stride away the wide bends are almost the same, so each look speaks as far as they are new.
    """
    aim(belief)
    _judge_bend(compass, belief, config)
    for axis in range(3):
        variance = component_row(compass, belief, axis, config)
        residual = _residual(compass, belief)
        expected = project(belief.covariance, compass.row, compass.column) + variance
        surprise = residual * residual / expected
        most = config.aid_gate**2
        told = min(surprise, most) + math.log(expected)
        belief.log_weight -= 0.5 * belief.wide_is_new * told
        if surprise <= most:
            measure(
                belief.estimate, belief.covariance, compass.row, residual, variance, compass.column
            )


@njit()
def _judge_bend(compass: Aid, belief: Aid, config: EskfConfig) -> None:
    """Judge how bent the field is here by the components that no heading changes.

    Doubt comes at once and goes slowly.
    """
    bend_var = belief.bend_var_ut2
    for axis in (ALONG, VERTICAL):
        expected = component_row(compass, belief, axis, config)
        expected += project(belief.covariance, compass.row, compass.column)
        residual = _residual(compass, belief)
        seen = max(residual * residual - expected, 0.0)
        weight = config.field_bend_rise if seen > bend_var else config.field_bend_fall
        weight *= belief.near_is_new * bend_var / (bend_var + expected)
        bend_var += weight * (seen - bend_var)
    bend_var = max(bend_var, config.field_bend_floor_ut**2)
    belief.bend_var_ut2 = bend_var
    for i in range(3):
        belief.covariance[NEAR + i, NEAR + i] += belief.near_is_new * bend_var
        belief.covariance[WIDE + i, WIDE + i] += belief.wide_is_new * belief.wide_var_ut2


@njit()
def aim(belief: Aid) -> None:
    """Set the horizontal direction of ``f``; north where it is unknown."""
    north, east = belief.estimate[FIELD], belief.estimate[FIELD + 1]
    strength = math.sqrt(north * north + east * east)
    belief.strength_ut = strength
    belief.aim_n[0] = north / strength if strength > 0.0 else 1.0
    belief.aim_n[1] = east / strength if strength > 0.0 else 0.0


@njit()
def is_known(belief: Aid, config: EskfConfig) -> bool:
    """Whether the horizontal field stands out from what is not known of it."""
    spread = belief.covariance[FIELD, FIELD] + belief.covariance[FIELD + 1, FIELD + 1]
    return bool(belief.strength_ut**2 > config.field_known_ratio**2 * spread)


@njit()
def component_row(compass: Aid, belief: Aid, axis: int, config: EskfConfig) -> float:
    """Write the measurement row of one component; return the variance that is its own.

    That includes what the linear model leaves out: the product of the errors of heading and
    of ``f``, and that sine and cosine are no straight lines.
    """
    ahead, right = belief.aim_n[0], belief.aim_n[1]
    heading_var = belief.covariance[0, 0]
    strength = belief.strength_ut
    variance = config.field_noise_ut**2
    sensitivity = 0.0
    if axis == ALONG:
        x, y, z = ahead, right, 0.0
        variance += 0.5 * (heading_var * strength) ** 2
    elif axis == VERTICAL:
        x, y, z = 0.0, 0.0, 1.0
    else:
        x, y, z = -right, ahead, 0.0
        spread = belief.covariance[FIELD, FIELD] + belief.covariance[FIELD + 1, FIELD + 1]
        variance += heading_var * spread
        bend_ratio = belief.bend_var_ut2 / max(strength * strength, 1.0)
        variance += belief.bend_var_ut2 * bend_ratio / config.field_bend_ratio**2
        if is_known(belief, config) and bend_ratio < config.field_bend_limit**2:
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
def _residual(compass: Aid, belief: Aid) -> float:
    """Return the measured component beyond the one expected, for the row just written."""
    seen = 0.0
    for i in range(3):
        seen += compass.row[FIELD + i] * compass.field_n_ut[i]
    for i in range(COMPASS_SIZE):
        seen -= compass.row[i] * belief.estimate[i]
    return float(seen)


@njit()
def north_of(belief: Aid) -> float:
    """Return where magnetic north lies in the frame as the main filter has it now."""
    return float(math.atan2(belief.aim_n[1], belief.aim_n[0]) - belief.estimate[0])


@njit()
def north_variance(compass: Aid, belief: Aid, earth_known: bool, config: EskfConfig) -> float:
    """Return the variance (rad^2) of ``north_of``, infinite among heavy steel.

    The frame is the walk's, turned by the error of heading, and both are known together.  To
    what the model knows is added what it cannot: a field that is bent alike all over, which
    shows, where the earth's is known, by strength and dip.  These are two components, too few
    to take their mean for all there is of the third, so it is doubted by their sum.
    """
    limit_ut = config.field_bend_limit * belief.strength_ut
    if belief.bend_var_ut2 > limit_ut * limit_ut:
        return math.inf
    p = belief.covariance
    ahead, right, strength = belief.aim_n[0], belief.aim_n[1], belief.strength_ut
    across_var = right * right * p[FIELD, FIELD] + ahead * ahead * p[FIELD + 1, FIELD + 1]
    across_var -= 2.0 * right * ahead * p[FIELD, FIELD + 1]
    with_heading = ahead * p[FIELD + 1, 0] - right * p[FIELD, 0]
    everywhere_var = config.field_everywhere_ut**2
    if earth_known:
        along_ut, down_ut = _off_earth_ut(compass, belief)
        everywhere_var = config.field_agreeing_ut**2 + along_ut * along_ut + down_ut * down_ut
    variance = (across_var + everywhere_var) / max(strength * strength, 1.0)
    variance += p[0, 0] - 2.0 * with_heading / max(strength, 1.0)
    return float(min(variance, ANYWHERE_RAD2))


@njit()
def earth_log_likelihood(compass: Aid, belief: Aid, config: EskfConfig) -> float:
    """Return how likely it is by the belief that strength and dip are as near to the earth's.

    Bent by as much as it believes, they would be off by as much.
    """
    p = belief.covariance
    ahead, right = belief.aim_n[0], belief.aim_n[1]
    along_ut, down_ut = _off_earth_ut(compass, belief)
    along_var = ahead * ahead * p[FIELD, FIELD] + right * right * p[FIELD + 1, FIELD + 1]
    along_var += 2.0 * ahead * right * p[FIELD, FIELD + 1] + config.field_agreeing_ut**2
    down_var = p[FIELD + 2, FIELD + 2] + config.field_agreeing_ut**2
    surprise = along_ut * along_ut / along_var + down_ut * down_ut / down_var
    return float(-0.5 * (surprise + math.log(along_var * down_var)))


@njit()
def _off_earth_ut(compass: Aid, belief: Aid) -> tuple[float, float]:
    """Return how far the field of the walk is off the earth's, along it and down."""
    along_ut = belief.strength_ut - compass.earth_horizontal_ut
    return along_ut, belief.estimate[FIELD + 2] - compass.earth_down_ut
