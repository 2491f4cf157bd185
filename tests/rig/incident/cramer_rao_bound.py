"""Cramér-Rao bound of a person's place from path and fixes, no plan considered.

The posterior Cramer-Rao bound (Tichavsky et al. 1998) of the simulated errors: they are linear
about the truth and normal but for the trackers' own words, so that it is the covariance of a
Kalman filter that knows the truth and every magnitude.  The engine's place, where all begin, and
the receiver on its roof are in it; what people learn of the building, from each other too, is not.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import PlaceFix
from tests.rig.incident import sensors as errors
from tests.rig.incident.building import SteelBuilding
from tests.rig.incident.people import BESIDE_ENGINE_M, RATE_HZ, Truth

Floats = NDArray[np.float64]

ENGINE_STATED_STD_M = 0.4  # how well a commander says where the engine stands, each axis
ENGINE_STD_M = math.hypot(ENGINE_STATED_STD_M, BESIDE_ENGINE_M)
# North, east, heading, drift rate and scale; then pairs: the receiver's slow error, what walls add,
# what all receivers share, the roof receiver's slow error, all of unit variance; the engine.
_HEADING, _DRIFT, _SCALE, _SLOW, _WALL, _COMMON, _ROOF, _ENGINE, _STATES = (
    2,
    3,
    4,
    5,
    7,
    9,
    11,
    13,
    15,
)
_LAST_S = {
    _SLOW: errors.OPEN_SLOW_S,
    _WALL: errors.WALL_SLOW_S,
    _COMMON: errors.COMMON_S,
    _ROOF: errors.ROOF_SLOW_S,
}


def bound_m2(
    truth: Truth,
    fixes: dict[int, PlaceFix],
    engine_fixes: dict[int, PlaceFix],
    building: SteelBuilding,
) -> tuple[Floats, Floats]:
    """Covariance of north and east, row by row (n, 2, 2): by what came until then, and by what
    came afterwards too (Rauch, Tung and Striebel 1965).
    """
    begin = [ENGINE_STD_M] * 2 + [math.pi, errors.DRIFT_STD_RADPS, errors.SCALE_STD, *[1.0] * 8]
    spread = np.diag(np.square([*begin, ENGINE_STATED_STD_M, ENGINE_STATED_STD_M]))
    for axis in (0, 1):
        spread[axis, _ENGINE + axis] = spread[_ENGINE + axis, axis] = ENGINE_STATED_STD_M**2
    fades = np.ones(_STATES)
    for first, lasts_s in _LAST_S.items():
        fades[first : first + 2] = math.exp(-1.0 / RATE_HZ / lasts_s)
    lengths_m = np.linalg.norm(truth.steps_m[:, :2], axis=1)
    moves, expected, known = np.empty((3, len(truth.t_s), _STATES, _STATES))
    for row, (north_m, east_m, _) in enumerate(truth.steps_m):
        moves[row], noise = _move(fades, (north_m, east_m, float(lengths_m[row])))
        spread = expected[row] = moves[row] @ spread @ moves[row].T + np.diag(noise)
        if row in engine_fixes:
            spread = _corrected(
                spread, errors.ROOF_WHITE_M, {_ENGINE: 1.0, _COMMON: errors.COMMON_M,
                _ROOF: errors.ROOF_SLOW_M},
            )  # fmt: skip
        if row in fixes:
            walls_m = errors.walls_m(building, *truth.place_m[row, :2].tolist())
            spread = _corrected(
                spread, errors.OPEN_WHITE_M, {0: 1.0, _COMMON: errors.COMMON_M,
                _SLOW: errors.OPEN_SLOW_M, _WALL: walls_m},
            )  # fmt: skip
        known[row] = spread
    return known[:, :2, :2].copy(), _afterwards(moves, expected, known)[:, :2, :2]


def draw_errors_m(rng: np.random.Generator, bounds_m2: Floats) -> Floats:
    """Errors (n, 2) of an estimate that is as good as can be."""
    roots = np.linalg.cholesky(bounds_m2 + 1e-9 * np.eye(2))
    drawn: Floats = np.einsum("nij,nj->ni", roots, rng.normal(size=(len(roots), 2)))
    return drawn


def _afterwards(moves: Floats, expected: Floats, known: Floats) -> Floats:
    for row in range(len(known) - 2, -1, -1):
        gain = np.linalg.solve(expected[row + 1], moves[row + 1] @ known[row]).T
        known[row] += gain @ (known[row + 1] - expected[row + 1]) @ gain.T
    return known


def _move(fades: Floats, step: tuple[float, float, float]) -> tuple[Floats, Floats]:
    """Transition of the state by a step (north, east and length), and the added variances."""
    north_m, east_m, length_m = step
    moving_s = 1.0 / RATE_HZ if length_m * RATE_HZ > errors.MOVING_MPS else 0.0
    move = np.diag(fades)
    move[0, [_HEADING, _SCALE]] = -east_m, north_m
    move[1, [_HEADING, _SCALE]] = north_m, east_m
    move[_HEADING, _DRIFT] = moving_s
    noise = 1.0 - fades**2
    noise[:2] = errors.STEP_M_PER_SQRT_M**2 * length_m
    noise[_HEADING] = errors.HEADING_RAD_PER_SQRT_M**2 * length_m
    noise[_DRIFT] = errors.DRIFT_WANDER_RADPS**2 * moving_s / 60.0
    return move, noise


def _corrected(spread: Floats, white_m: float, parts: dict[int, float]) -> Floats:
    """By a fix that is the sum of such parts of the state, each a pair."""
    observe = np.zeros((2, _STATES))
    for first, part in parts.items():
        observe[0, first] = observe[1, first + 1] = part
    noise = white_m**2 * np.eye(2)
    gain = spread @ observe.T @ np.linalg.inv(observe @ spread @ observe.T + noise)
    return np.asarray(spread - gain @ observe @ spread)
