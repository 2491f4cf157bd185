"""How well anybody could know a person's place from path and fixes alone, no plan considered.

The posterior Cramer-Rao bound (Tichavsky et al. 1998) of the simulated errors: they are linear
about the truth and normal but for the trackers' own words, so that it is the covariance of a
Kalman filter that knows the truth and every magnitude.  State: north, east, heading, drift rate,
scale, and the two slow errors of the receiver in units of their standard deviation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from base_station.bench import incident_sensors as errors
from base_station.bench.incident_building import SteelBuilding
from base_station.bench.incident_people import RATE_HZ, Truth
from base_station.fusion.port import PlaceFix

Floats = NDArray[np.float64]

ENGINE_STD_M = 0.5
ANYWHERE_STD_M = 100.0
_HEADING, _DRIFT, _SCALE = 2, 3, 4


def bound_m2(truth: Truth, fixes: dict[int, PlaceFix], building: SteelBuilding) -> Floats:
    """Covariance of north and east, row by row (n, 2, 2)."""
    begin_m = ENGINE_STD_M if truth.from_engine else ANYWHERE_STD_M
    begin = [begin_m, begin_m, math.pi, errors.DRIFT_STD_RADPS, errors.SCALE_STD, *[1.0] * 4]
    spread = np.diag(np.square(begin))
    steps_m = truth.steps_m
    lengths_m = np.linalg.norm(steps_m[:, :2], axis=1)
    fades = np.ones(9)
    fades[5:7] = math.exp(-1.0 / RATE_HZ / errors.OPEN_SLOW_S)
    fades[7:9] = math.exp(-1.0 / RATE_HZ / errors.WALL_SLOW_S)
    bounds = np.empty((len(truth.t_s), 2, 2))
    for row, (north_m, east_m, _) in enumerate(steps_m):
        length_m = float(lengths_m[row])
        moving_s = 1.0 / RATE_HZ if length_m * RATE_HZ > errors.MOVING_MPS else 0.0
        move = np.diag(fades)
        move[0, [_HEADING, _SCALE]] = -east_m, north_m
        move[1, [_HEADING, _SCALE]] = north_m, east_m
        move[_HEADING, _DRIFT] = moving_s
        noise = 1.0 - fades**2
        noise[:2] = errors.STEP_M_PER_SQRT_M**2 * length_m
        noise[_HEADING] = errors.HEADING_RAD_PER_SQRT_M**2 * length_m
        noise[_DRIFT] = errors.DRIFT_WANDER_RADPS**2 * moving_s / 60.0
        spread = move @ spread @ move.T + np.diag(noise)
        if row in fixes:
            spread = _corrected(spread, building, truth.place_m[row])
        bounds[row] = spread[:2, :2]
    return bounds


def draw_errors_m(rng: np.random.Generator, bounds_m2: Floats) -> Floats:
    """Errors (n, 2) of an estimate that is as good as can be."""
    roots = np.linalg.cholesky(bounds_m2 + 1e-9 * np.eye(2))
    drawn: Floats = np.einsum("nij,nj->ni", roots, rng.normal(size=(len(roots), 2)))
    return drawn


def _corrected(spread: Floats, building: SteelBuilding, place_m: Floats) -> Floats:
    observe = np.zeros((2, 9))
    observe[0, 0] = observe[1, 1] = 1.0
    observe[0, 5] = observe[1, 6] = errors.OPEN_SLOW_M
    observe[0, 7] = observe[1, 8] = errors.walls_m(building, *place_m[:2].tolist())
    noise = errors.OPEN_WHITE_M**2 * np.eye(2)
    gain = spread @ observe.T @ np.linalg.inv(observe @ spread @ observe.T + noise)
    return np.asarray(spread - gain @ observe @ spread)
