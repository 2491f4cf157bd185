"""Stated errors of dead reckoning against drawn errors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.dead_reckoning import DeadReckoning
from base_station.fusion.kernels import OdometryIncrement

STEPS = np.array([[1.0, 0.0]] * 60 + [[0.0, 1.0]] * 30 + [[-1.0, 0.0]] * 40)


def walked(reckoning: DeadReckoning, drift_radps: float) -> DeadReckoning:
    for north_m, east_m in STEPS.tolist():
        reckoning.predict(OdometryIncrement(north_m, east_m, 0.0, 1.0, 1.0, 0.0, 0.0, drift_radps))
    return reckoning


@pytest.mark.parametrize(
    ("turn_std_rad", "drift_radps", "scale_std"),
    [(0.1, 0.0, 0.0), (1.2, 0.0, 0.0), (0.0, 5e-4, 0.0), (0.0, 0.0, 0.05)],
)
def test_covariance_is_that_of_the_errors(
    turn_std_rad: float, drift_radps: float, scale_std: float
) -> None:
    reckoning = DeadReckoning(scale_std)
    reckoning.set_turn(0.7, turn_std_rad)
    reckoning.set_place((5.0, -3.0), (0.0, 0.0, 0.0), (0.0, 0.0))
    estimate = walked(reckoning, drift_radps).estimate_at(tuple(STEPS.sum(axis=0).tolist()))
    rng = np.random.default_rng(1)
    t_s = np.arange(len(STEPS)) + 0.5
    steps = STEPS[:, 0] + 1j * STEPS[:, 1]
    angles = rng.normal(0.0, 1.0, 20_000)[:, None] * turn_std_rad
    angles = angles + rng.normal(0.0, 1.0, 20_000)[:, None] * drift_radps * t_s
    scales = 1.0 + scale_std * rng.normal(0.0, 1.0, 20_000)
    ends = scales * (np.exp(1j * (0.7 + angles)) @ steps) + complex(5.0, -3.0)
    errors = ends - complex(estimate.north_m, estimate.east_m)
    between_m2 = estimate.correlation_ne * estimate.std_north_m * estimate.std_east_m
    stated_m2 = [estimate.std_north_m**2, estimate.std_east_m**2, between_m2]
    north_m, east_m = errors.real, errors.imag
    drawn_m2 = [np.mean(north_m**2), np.mean(east_m**2), np.mean(north_m * east_m)]
    assert stated_m2 == pytest.approx(drawn_m2, rel=0.05, abs=0.04 * max(drawn_m2))


def test_error_at_the_known_place_is_its_own() -> None:
    reckoning = DeadReckoning(0.02)
    reckoning.set_turn(0.0, 0.1)
    reckoning.set_place((0.0, 0.0), (4.0, 9.0, 1.0), (0.0, 0.0))
    for _ in range(100):
        reckoning.predict(OdometryIncrement(1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1e-3))
    there = reckoning.estimate_at((0.0, 0.0), (100.0, 0.0))
    assert (there.std_north_m, there.std_east_m) == pytest.approx((2.0, 3.0))
    assert there.correlation_ne == pytest.approx(1.0 / 6.0)
    end = reckoning.estimate_at((100.0, 0.0))
    assert end.std_east_m == pytest.approx(math.sqrt(9.0 + 10.0**2 * 0.99 + 5.0**2), rel=0.02)
