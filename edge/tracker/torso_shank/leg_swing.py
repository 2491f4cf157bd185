"""Vertical-straight-line instants of a shank (Chiu 2011, section 4.2.1).

While its foot stands the leg turns forward over it; where it passes the vertical, thigh and shank
are in line and its rate is near its minimum.  There the hip's speed is that rate times the leg's
length (4.6 to 4.8).

Any mount will do: rests show which way the leg points, and its hinge is the axis about which the
shank turns most.  A swing is faster than a stance, so the hinge's sign is that of the slower way.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats
from edge.tracker.preprocessing.sample_ring import Ring, reach, span
from edge.tracker.torso_shank.state import ShankState, TorsoShankConfig
from edge.tracker.trunk.attitude import begin_attitude, follow_attitude
from edge.tracker.trunk.state import Row


@njit()
def follow_shank(
    ring: Ring, shank: ShankState, k: int, angle_b_rad: Floats, config: TorsoShankConfig
) -> None:
    """Take sample ``k``; an instant is left in ``shank``.  ``angle_b_rad`` is scratch."""
    mask = len(ring) - 1
    row = ring[k & mask]
    if k == 0:
        begin_attitude(ring, shank.trunk, k, config.trunk)
        _point_leg(row, shank, 1.0)
    else:
        dt_s = row.t_s - ring[(k - 1) & mask].t_s
        if 0.0 < dt_s <= config.silence_s:
            follow_attitude(ring, shank.trunk, k, dt_s, angle_b_rad, config.trunk)
            _learn_leg(row, shank, dt_s, config)
            _learn_hinge(row, shank, dt_s, config)
            _find_instant(ring, shank, k, config)
    shank.walked_ns = max(shank.walked_ns, row.t_ns)


@njit()
def _point_leg(row: Row, shank: ShankState, share: float) -> None:
    """Turn the leg's axis by a share towards the force of a sample."""
    force = row.accel_mps2
    norm = math.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    if norm == 0.0:
        return
    square = 0.0
    for i in range(3):
        shank.leg_b[i] += share * (force[i] / norm - shank.leg_b[i])
        square += shank.leg_b[i] ** 2
    for i in range(3):
        shank.leg_b[i] /= math.sqrt(square)


@njit()
def _learn_leg(row: Row, shank: ShankState, dt_s: float, config: TorsoShankConfig) -> None:
    """Learn the axis of the leg while the wearer stands: legs are upright then."""
    if not shank.trunk.still:
        return
    force = row.accel_mps2
    norm = math.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    along = 0.0
    for i in range(3):
        along += shank.leg_b[i] * force[i]
    if along < math.cos(config.leg_tilt_rad) * norm:
        return
    shank.leg_s = min(shank.leg_s + dt_s, config.leg_memory_s)
    _point_leg(row, shank, dt_s / shank.leg_s)


@njit()
def _learn_hinge(row: Row, shank: ShankState, dt_s: float, config: TorsoShankConfig) -> None:
    """Follow the axis of most turning by one step of power iteration a sample."""
    products, hinge, leg = shank.rate_products, shank.hinge_b, shank.leg_b
    share = dt_s / config.hinge_memory_s
    across_radps = (
        row.gyro_radps[0] - shank.trunk.gyro_bias_radps[0],
        row.gyro_radps[1] - shank.trunk.gyro_bias_radps[1],
        row.gyro_radps[2] - shank.trunk.gyro_bias_radps[2],
    )
    along = across_radps[0] * leg[0] + across_radps[1] * leg[1] + across_radps[2] * leg[2]
    rate_radps = 0.0
    square = 0.0
    for i in range(3):
        for j in range(3):
            product = (across_radps[i] - along * leg[i]) * (across_radps[j] - along * leg[j])
            products[i, j] += share * (product - products[i, j])
        square += hinge[i] ** 2
    if square == 0.0:
        for i in range(3):
            hinge[i] = across_radps[i] - along * leg[i]
    turned = (
        products[0, 0] * hinge[0] + products[0, 1] * hinge[1] + products[0, 2] * hinge[2],
        products[1, 0] * hinge[0] + products[1, 1] * hinge[1] + products[1, 2] * hinge[2],
        products[2, 0] * hinge[0] + products[2, 1] * hinge[1] + products[2, 2] * hinge[2],
    )
    norm = math.sqrt(turned[0] ** 2 + turned[1] ** 2 + turned[2] ** 2)
    if norm == 0.0:
        return
    for i in range(3):
        hinge[i] = turned[i] / norm
        rate_radps += across_radps[i] * hinge[i]
    shank.skewness += share * (rate_radps**3 - shank.skewness)
    if shank.skewness > 0.0:  # the fast way is the swing's, which is backward about the hinge
        shank.skewness = -shank.skewness
        for i in range(3):
            hinge[i] = -hinge[i]
        shank.pitch_rad = -shank.pitch_rad


@njit()
def _find_instant(ring: Ring, shank: ShankState, k: int, config: TorsoShankConfig) -> None:
    before_rad = shank.pitch_rad
    shank.pitch_rad = _pitch_rad(shank)
    if not before_rad < 0.0 <= shank.pitch_rad:
        return
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    first = last = k
    while first > 0 and k - first < span(ring):
        if now_s - ring[(first - 1) & mask].t_s > config.area_s:
            break
        first -= 1
    stop = min(shank.trunk.timed, reach(ring, k))
    while last + 1 < stop and ring[(last + 1) & mask].t_s - now_s <= config.area_s:
        last += 1
    least_radps, sum_radps, averaged = math.inf, 0.0, 0
    for j in range(first, last + 1):
        rate_radps = _hinge_rate_radps(ring[j & mask], shank)
        least_radps = min(least_radps, rate_radps)
        if abs(ring[j & mask].t_s - now_s) <= 0.5 * config.average_s:
            sum_radps += rate_radps
            averaged += 1
    mean_radps = sum_radps / averaged
    most_radps = min(
        config.most_radps, config.above_least * max(least_radps, 0.0) + config.above_radps
    )
    if config.least_radps <= mean_radps <= most_radps:
        shank.has_instant = True
        shank.instant_radps = mean_radps


@njit()
def _pitch_rad(shank: ShankState) -> float:
    """Return the angle of the leg before the vertical, about its hinge."""
    rotation, leg, hinge = shank.trunk.rotation_nb, shank.leg_b, shank.hinge_b
    leg_n = (
        rotation[0, 0] * leg[0] + rotation[0, 1] * leg[1] + rotation[0, 2] * leg[2],
        rotation[1, 0] * leg[0] + rotation[1, 1] * leg[1] + rotation[1, 2] * leg[2],
        rotation[2, 0] * leg[0] + rotation[2, 1] * leg[1] + rotation[2, 2] * leg[2],
    )
    hinge_north = rotation[0, 0] * hinge[0] + rotation[0, 1] * hinge[1] + rotation[0, 2] * hinge[2]
    hinge_east = rotation[1, 0] * hinge[0] + rotation[1, 1] * hinge[1] + rotation[1, 2] * hinge[2]
    level = math.sqrt(hinge_north**2 + hinge_east**2)
    if level == 0.0:
        return 0.0
    # Forward is hinge x up, with up = (0, 0, -1).
    ahead = (-hinge_east * leg_n[0] + hinge_north * leg_n[1]) / level
    return math.atan2(ahead, -leg_n[2])


@njit()
def _hinge_rate_radps(row: Row, shank: ShankState) -> float:
    rate_radps = 0.0
    for i in range(3):
        rate_radps += (row.gyro_radps[i] - shank.trunk.gyro_bias_radps[i]) * shank.hinge_b[i]
    return rate_radps
