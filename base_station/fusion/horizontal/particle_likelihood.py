"""Likelihoods by which particles are weighted: walls, GNSS observations and a posterior."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.heading_hypotheses import GnssObservation, slow_error_jacobian
from base_station.fusion.horizontal.particles import Particles
from base_station.fusion.horizontal.resampling import JITTER_M, mahalanobis2
from base_station.fusion.horizontal.state import SCALE
from base_station.fusion.wall_likelihood import (
    OFF_FLOOR,
    OFF_STAIRS,
    THROUGH_WALL,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.wall_crossing import BESIDE, OUTSIDE, WALL

Floats = NDArray[np.float64]


class WallLikelihood(NamedTuple):
    """Log likelihoods (n,) of a step."""

    crossed: Floats  # of walls crossed and stairs left
    met: Floats  # and of walls that are too close


def wall_likelihood(
    particles: Particles,
    grid: FloorGrid,
    floor: int,
    from_m: Floats,
    *,
    climbs: bool,
    log_beside: float,
) -> WallLikelihood:
    """Likelihood of the walls met between the places (n, 2) before and now; ``log_beside``: log
    likelihood of a step beside a wall.
    """
    to_m = particles.states[:, :2]
    met = grid.crossings(floor, from_m, to_m)
    crossed = math.log(THROUGH_WALL) * (met == WALL) + math.log(OFF_FLOOR) * (met == OUTSIDE)
    if climbs and grid.has_stairs(floor):
        crossed = crossed + math.log(OFF_STAIRS) * ~grid.on_stairs(floor, to_m)
    return WallLikelihood(crossed, crossed + log_beside * (met == BESIDE))


class Innovations(NamedTuple):
    """Innovations of a GNSS observation."""

    apart: Floats  # (n, 2), by particle
    spread: Floats  # (2, 2), their covariance
    observe: Floats  # (2, 4), Jacobian of the slow errors


def innovations(particles: Particles, observation: GnssObservation, ahead_m: Floats) -> Innovations:
    """``ahead_m``: own path north and east that the particles have not been moved along yet."""
    since_m = particles.turned(
        observation.since_north_m - ahead_m[0], observation.since_east_m - ahead_m[1]
    )
    seen_m = np.array([observation.north_m, observation.east_m])
    observe = slow_error_jacobian(observation)
    apart = seen_m + since_m - particles.states[:, :2] - particles.slow @ observe.T
    spread = observe @ particles.slow_covariance @ observe.T + observation.white_m2 * np.eye(2)
    return Innovations(apart, spread, observe)


def distance2(particles: Particles, innovations: Innovations) -> float:
    """Squared distance to the particles as one normal distribution, chi-square of two degrees of
    freedom.
    """
    apart, spread, _ = innovations
    weights = particles.weights
    middle = weights @ apart
    off = apart - middle
    whole = spread + (off * weights[:, None]).T @ off
    return float(middle @ np.linalg.solve(whole, middle))


def posterior_log_ratio(
    particles: Particles, mean: Floats, covariance: Floats, ahead_m: Floats
) -> Floats:
    """Logarithm (n,) of the density of moments (5,), (5, 5) of ``[north, east, c, s, drift]`` over
    the one of the particles' own moments; ``ahead_m`` as for ``innovations``.
    """
    c, s = float(mean[2]), float(mean[3])
    scale = math.hypot(c, s)
    to_own = np.zeros((5, 5))
    to_own[[0, 1, 3], [0, 1, 4]] = 1.0
    to_own[2, 2:4] = np.array([-s, c]) / scale**2
    to_own[SCALE, 2:4] = np.array([c, s]) / scale
    here = particles.states.copy()
    here[:, :2] += particles.turned(float(ahead_m[0]), float(ahead_m[1]))
    weights = particles.weights
    turn_rad = math.atan2(float(weights @ np.sin(here[:, 2])), float(weights @ np.cos(here[:, 2])))
    here[:, 2] = turn_rad + (here[:, 2] - turn_rad + math.pi) % math.tau - math.pi
    own = here - weights @ here
    known = np.array([mean[0], mean[1], math.atan2(s, c), mean[4], scale])
    known[2] = turn_rad + (known[2] - turn_rad + math.pi) % math.tau - math.pi
    floor = np.diag([JITTER_M**2, JITTER_M**2, 1e-6, 1e-12, 1e-6])
    own_spread = (own * weights[:, None]).T @ own + floor
    spread = to_own @ covariance @ to_own.T + floor
    return np.asarray(0.5 * (mahalanobis2(own, own_spread) - mahalanobis2(here - known, spread)))
