"""Dead reckoning by steps: position, its stated errors, and the rows between two steps.

A step length that was learnt from other people is off by the same share at every step, and a
heading by the same angle, so their errors add up as the walk does and leave a walk out and back
near its start.  What differs from step to step adds up as a random walk: more where the wearer
turns, and where a walk begins, of which no detector feels every step.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.interface import Quality, Reason
from edge.tracker.preprocessing.sample_ring import Ring, history
from edge.tracker.trunk.attitude import add_forward
from edge.tracker.trunk.pressure_height import height_var_m2
from edge.tracker.trunk.state import Row, TrunkConfig, TrunkState
from edge.tracker.trunk.unseen_motion import unseen_m2

GOOD, DEGRADED, LOST = int(Quality.GOOD), int(Quality.DEGRADED), int(Quality.LOST)
UNCERTAIN, UNSETTLED = int(Reason.UNCERTAIN), int(Reason.UNSETTLED)


@njit()
def heading_std_rad(trunk: TrunkState, t_s: float, config: TrunkConfig) -> float:
    """Return the stated deviation of the heading since the start."""
    if trunk.has_compass:
        return config.compass_std_rad
    known = trunk.bias_s >= config.bias_known_s
    bias_radps = config.known_bias_radps if known else config.unknown_bias_radps
    return float(math.sqrt(config.heading_std_rad**2 + (bias_radps * t_s) ** 2))


@njit()
def mean_forward(ring: Ring, trunk: TrunkState, first: int, last: int, forward_n: Floats) -> None:
    """Write the mean direction (2,) of the front from sample ``first`` to ``last``."""
    forward_n[0] = forward_n[1] = 0.0
    for k in range(max(first, last - history(ring)), last + 1):
        add_forward(ring, trunk, k, forward_n)
    level = math.sqrt(forward_n[0] ** 2 + forward_n[1] ** 2)
    if level > 0.0:
        forward_n[0] /= level
        forward_n[1] /= level


@njit()
def begin_walk(trunk: TrunkState, config: TrunkConfig) -> None:
    """Widen the place by what the first and the last step of a walk are off."""
    trunk.random_m2 += config.start_std_m**2


@njit()
def take_step(
    trunk: TrunkState,
    length_m: float,
    length_std: float,
    forward_n: Floats,
    t_s: float,
    config: TrunkConfig,
) -> None:
    """Move by one step along ``forward_n`` (2,); ``length_std`` is a share of its length."""
    turned_m = length_m * heading_std_rad(trunk, t_s, config)
    north_m, east_m = length_m * forward_n[0], length_m * forward_n[1]
    trunk.position_n_m[0] += north_m
    trunk.position_n_m[1] += east_m
    trunk.length_error_m[0] += length_std * north_m
    trunk.length_error_m[1] += length_std * east_m
    trunk.heading_error_m[0] -= turned_m * forward_n[1]
    trunk.heading_error_m[1] += turned_m * forward_n[0]
    turned_by = abs(trunk.facing_n[0] * forward_n[1] - trunk.facing_n[1] * forward_n[0])
    trunk.facing_n[0], trunk.facing_n[1] = forward_n[0], forward_n[1]
    random_std = config.step_std + config.turn_step_std * turned_by
    trunk.random_m2 += (random_std * length_m) ** 2
    trunk.distance_m += length_m
    trunk.steps += 1
    trunk.moving_s = 0.0


@njit()
def watch_motion(trunk: TrunkState, dt_s: float, config: TrunkConfig) -> None:
    """Widen the place while the wearer moves, and no step is found."""
    if trunk.quiet_s >= config.unseen.rest_s:
        trunk.moving_s = 0.0
    if trunk.still:
        return
    trunk.moving_s += dt_s
    trunk.random_m2 += unseen_m2(trunk.moving_s, dt_s, config.unseen)


@njit()
def write_rows(
    ring: Ring,
    trunk: TrunkState,
    first: int,
    last: int,
    from_n_m: Floats,
    from_distance_m: float,
    config: TrunkConfig,
) -> None:
    """Write the rows from ``first`` to ``last``: an even way to where the trunk is now."""
    mask = len(ring) - 1
    begin_s, end_s = ring[(first - 1) & mask].t_s, ring[last & mask].t_s
    lasts_s = max(end_s - begin_s, 1e-6)
    for k in range(first, last + 1):
        row = ring[k & mask]
        share = (row.t_s - begin_s) / lasts_s
        for i in range(2):
            step_m = trunk.position_n_m[i] - from_n_m[i]
            row.position_n_m[i] = from_n_m[i] + share * step_m
            row.velocity_n_mps[i] = step_m / lasts_s
        row.distance_m = from_distance_m + share * (trunk.distance_m - from_distance_m)
        row.steps = trunk.steps // 2
        state_errors(trunk, row, config)


@njit()
def write_standing(ring: Ring, trunk: TrunkState, k: int, config: TrunkConfig) -> None:
    """Write attitude and height of sample ``k``, and the place of the last step."""
    row = ring[k & (len(ring) - 1)]
    row.position_n_m[2] = -trunk.height_m
    row.velocity_n_mps[2] = 0.0
    for i in range(4):
        row.quaternion_nb[i] = trunk.quaternion_nb[i]
    row.heading_std_rad = heading_std_rad(trunk, row.t_s, config)
    row.magnetic_north_rad = 0.0
    row.magnetic_north_std_rad = math.inf  # where the sensor faces on its wearer is not known
    row.stationary = trunk.still
    reasons = row.flags
    if not trunk.has_compass and trunk.bias_s < config.bias_known_s:
        reasons |= UNSETTLED
    row.reasons = reasons
    place_row(ring, trunk, k, config)


@njit()
def place_row(ring: Ring, trunk: TrunkState, k: int, config: TrunkConfig) -> None:
    """Put the row of sample ``k`` where the last step has ended."""
    row = ring[k & (len(ring) - 1)]
    for i in range(2):
        row.position_n_m[i] = trunk.position_n_m[i]
        row.velocity_n_mps[i] = 0.0
    row.distance_m = trunk.distance_m
    row.steps = trunk.steps // 2  # strides
    state_errors(trunk, row, config)


@njit()
def state_errors(trunk: TrunkState, row: Row, config: TrunkConfig) -> None:
    """Write the stated covariance of the place into ``row``, and the quality that follows."""
    length_m, heading_m = trunk.length_error_m, trunk.heading_error_m
    covariance = row.position_cov_m2
    for i in range(3):
        for j in range(3):
            covariance[i, j] = 0.0
    for i in range(2):
        for j in range(2):
            covariance[i, j] = length_m[i] * length_m[j] + heading_m[i] * heading_m[j]
        covariance[i, i] += trunk.random_m2 + config.place_std_m**2
    covariance[2, 2] = height_var_m2(trunk, row.t_s, config)
    std_m = math.sqrt(covariance[0, 0] + covariance[1, 1])
    reasons = row.reasons & ~UNCERTAIN
    row.quality = GOOD if reasons & ~UNSETTLED == 0 else DEGRADED
    if std_m > config.degraded_m:
        reasons |= UNCERTAIN
        row.quality = LOST if std_m > config.lost_m else DEGRADED
    row.reasons = reasons


@njit()
def release_standing(ring: Ring, trunk: TrunkState, k: int, config: TrunkConfig) -> None:
    """Release what has waited too long for a step to end, and at rest everything up to ``k``."""
    mask = len(ring) - 1
    if trunk.still:
        trunk.released = k + 1
        return
    now_s = ring[k & mask].t_s
    while trunk.released <= k and (
        now_s - ring[trunk.released & mask].t_s >= config.hold_s
        or k - trunk.released >= history(ring)
    ):
        trunk.released += 1
