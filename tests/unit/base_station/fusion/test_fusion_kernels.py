"""Compiled kernels of the station's filters against ``filterpy``."""

from __future__ import annotations

import math

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray

from base_station.fusion import kernels
from base_station.fusion.kernels import HEIGHT, PLANE, HorizontalEstimate, Record

STATES, DRIFT = 9, 8  # of ``HorizontalFilter``

Floats = NDArray[np.float64]


def same(found: object, expected: object) -> None:
    np.testing.assert_allclose(np.array(found), np.array(expected), rtol=1e-10, atol=1e-12)


def filter_of(states: int, seed: int) -> KalmanFilter:
    """A filter in some state, with all states correlated."""
    rng = np.random.default_rng(seed)
    mixed = rng.normal(size=(states, states))
    found = KalmanFilter(dim_x=states, dim_z=1)
    found.x, found.P = rng.normal(size=(states, 1)), mixed @ mixed.T
    return found


def record_of(kind: np.dtype[np.void], state: KalmanFilter) -> Record:
    """The same state in the layout of the kernels."""
    record = np.zeros(1, kind)
    record["mean"], record["covariance"] = state.x[:, 0], state.P
    return record


def estimate_before(
    mean: Floats, covariance: Floats, north_m: float, east_m: float
) -> HorizontalEstimate:
    return HorizontalEstimate(*kernels.estimate_before(mean[:, 0], covariance, north_m, east_m))


@pytest.mark.parametrize("seed", range(5))
def test_walk_equals_the_prediction_of_filterpy(seed: int) -> None:
    expected = filter_of(STATES, seed)
    plane = record_of(PLANE, expected)
    north_m, east_m, moving_s, place_var_m2, turn_var, drift_var = 0.7, -0.4, 0.5, 0.02, 0.03, 0.04
    drifted_rad = float(expected.x[DRIFT, 0]) * moving_s
    a, b = math.cos(drifted_rad), math.sin(drifted_rad)
    c = a * expected.x[2, 0] - b * expected.x[3, 0]
    s = b * expected.x[2, 0] + a * expected.x[3, 0]
    jacobian, noise = np.eye(STATES), np.zeros((STATES, STATES))
    jacobian[0, 2:4], jacobian[1, 2:4] = (north_m, -east_m), (east_m, north_m)
    jacobian[2, 2:4], jacobian[3, 2:4] = (a, -b), (b, a)
    # The place moves by the turn after the drift, which the covariance does not distinguish.
    jacobian[2, DRIFT], jacobian[3, DRIFT] = -s * moving_s, c * moving_s
    across = np.array([-s, c])
    noise[:2, :2] = place_var_m2 * np.eye(2)
    noise[2:4, 2:4] = turn_var * np.outer(across, across)
    noise[DRIFT, DRIFT] = drift_var

    kernels.predict_horizontal(plane, north_m, east_m, moving_s, place_var_m2, turn_var, drift_var)
    expected.predict(F=jacobian, Q=noise)

    mean = plane["mean"][0]
    same(plane["covariance"][0], expected.P)
    moved = (c * north_m - s * east_m, s * north_m + c * east_m)
    same(mean[:2] - filter_of(STATES, seed).x[:2, 0], moved)
    same(mean[2:4], (c, s))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("step_m", [0.0, 40.0], ids=["steady", "a step of pressure"])
def test_barometer_equals_the_update_of_filterpy(seed: int, step_m: float) -> None:
    expected = filter_of(3, seed)
    height = record_of(HEIGHT, expected)
    down_m, wander_m2, noise_m2, gate2 = (
        float(expected.x[0, 0] + expected.x[2, 0]) + 0.1 + step_m,
        0.01,
        0.09,
        9.0,
    )
    expected.P[2, 2] += wander_m2 + ((0.1 + step_m) ** 2 if step_m else 0.0)

    kernels.update_barometer(height, down_m, wander_m2, noise_m2, gate2)
    observe = np.array([[1.0, 0.0, 1.0]])
    expected.update(np.array([[down_m]]), R=np.array([[noise_m2]]), H=observe)

    same(height["mean"][0], expected.x[:, 0])
    same(height["covariance"][0], expected.P)


def test_place_before_is_the_present_one_minus_the_path() -> None:
    now = filter_of(STATES, 1)
    north_m, east_m = 3.0, -2.0
    back = np.zeros((2, STATES))
    back[:, :2], back[:, 2:4] = np.eye(2), [[-north_m, east_m], [-east_m, -north_m]]
    place, spread = back @ now.x[:, 0], back @ now.P @ back.T

    placed = estimate_before(now.x, now.P, north_m, east_m)

    same((placed.north_m, placed.east_m), place)
    stds = np.array([placed.std_north_m, placed.std_east_m])
    same(stds**2, np.diag(spread))
    assert placed.correlation_ne == pytest.approx(spread[0, 1] / stds.prod())
    assert placed.turn_rad == pytest.approx(math.atan2(now.x[3, 0], now.x[2, 0]))


def test_state_without_a_direction_has_no_turn() -> None:
    placed = estimate_before(np.zeros((STATES, 1)), np.eye(STATES), 0.0, 0.0)
    assert (placed.turn_rad, placed.turn_std_rad) == (0.0, math.pi)


def test_place_is_less_sure_by_the_added_variance() -> None:
    placed = estimate_before(np.eye(STATES)[:, 2:3], 9.0 * np.eye(STATES), 0.0, 0.0)
    assert placed.inflated(16.0).std_north_m == pytest.approx(5.0)


def test_nothing_is_compiled_while_a_station_is_live() -> None:
    """A kernel refuses types that it was not compiled for."""
    state = filter_of(STATES, 2)
    with pytest.raises(TypeError):
        kernels.predict_horizontal(state.x, 1.0, 2.0, 0.2, 0.1, 0.1, 0.1)


def climb(height: Record, stretch: tuple[float, float, float], *, moves: bool = True) -> None:
    """Variances: 0.05 m2 a metre climbed, 0.005 a metre walked, storeys change by half a metre."""
    kernels.predict_height(height, stretch, moves, (0.05, 0.005, 0.5))


def test_climb_equals_the_prediction_of_filterpy() -> None:
    expected = filter_of(3, 4)
    height = record_of(HEIGHT, expected)
    climb(height, (-0.3, 1.0, 0.0))
    expected.predict(
        u=np.array([[-0.3]]), B=np.eye(3)[:, :1], F=np.eye(3), Q=np.diag([0.02, 0.0, 0.0])
    )
    same(height["mean"][0], expected.x[:, 0])
    same(height["covariance"][0], expected.P)


def test_growing_deviation_in_a_ride_adds_variance_until_the_wearer_walks() -> None:
    height = np.zeros(1, HEIGHT)
    path = height["path"][0]
    climb(height, (0.0, 1.0, 0.2))
    climb(height, (-3.0, 0.0, 0.7), moves=False)
    assert path[kernels.RIDE_VAR_M2] == pytest.approx(0.7**2 - 0.2**2)
    assert path[kernels.RIDDEN_M] == -3.0
    assert height["covariance"][0, 0, 0] == pytest.approx(0.2**2)  # beside the doubt
    climb(height, (0.0, 1.0, 0.7))
    assert path[kernels.RIDE_VAR_M2] == path[kernels.RIDDEN_M] == 0.0
    assert height["covariance"][0, 0, 0] == pytest.approx(0.7**2)
    assert height["mean"][0, 0] == -3.0


def test_climb_is_no_walk_on_the_level() -> None:
    height = np.zeros(1, HEIGHT)
    path = height["path"][0]
    for _ in range(4):
        climb(height, (-0.1, 2.0, 0.0))
    assert path[kernels.LEVEL_M] == pytest.approx(8.0)
    climb(height, (-0.2, 1.0, 0.0))
    assert path[kernels.LEVEL_M] == 0.0
