"""Drift rate of a unit's heading in the filter follows the rate that the unit states."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.horizontal.horizontal import HorizontalFilter
from base_station.fusion.horizontal.map_particle_filter import MapParticleFilter
from base_station.fusion.horizontal.state import PATH
from base_station.fusion.kernels import DRIFT, STATES
from base_station.fusion.parameters import Parameters

KIND = Parameters()


def drifting(rate_radps: float, std_radps: float) -> HorizontalFilter:
    """A filter that has found such a rate, of a unit that drifts by up to 1e-3."""
    plane = HorizontalFilter(KIND.scale_std, KIND.linear_rad, KIND.drift_wander_radps)
    plane.set_drift_std(1e-3)
    plane.set_start((0.0, 0.0), 1.0, 0.0, 0.05)
    mean, covariance = plane.moments()
    mean[DRIFT], covariance[DRIFT, DRIFT] = rate_radps, std_radps**2
    covariance[DRIFT, 0] = covariance[0, DRIFT] = 0.1 * std_radps
    plane.set_posterior(mean[PATH], covariance[np.ix_(PATH, PATH)])
    return plane


def test_found_drift_is_scaled_with_a_smaller_stated_drift() -> None:
    plane = drifting(4e-4, 2e-4)
    assert plane.set_drift_std(5e-4) == 0.5
    mean, covariance = plane.moments()
    assert mean[DRIFT] == pytest.approx(2e-4)
    assert math.sqrt(covariance[DRIFT, DRIFT]) == pytest.approx(1e-4)
    assert covariance[DRIFT, 0] == covariance[0, DRIFT] == pytest.approx(1e-5)
    assert np.linalg.eigvalsh(covariance).min() > -1e-12


def test_little_less_is_no_change_and_more_is_less_known() -> None:
    plane = drifting(4e-4, 2e-4)
    assert plane.set_drift_std(9.5e-4) == 1.0
    assert plane.moments()[0][DRIFT] == pytest.approx(4e-4)
    assert plane.set_drift_std(2e-3) == 1.0
    mean, covariance = plane.moments()
    assert mean[DRIFT] == pytest.approx(4e-4)
    assert covariance[DRIFT, DRIFT] == pytest.approx(2e-4**2 + 2e-3**2 - 1e-3**2)


def test_drifts_of_a_cloud_are_scaled_by_the_same_share() -> None:
    covariance = np.diag([1.0, 1.0, 1e-4, 1e-4, *[1.0] * (STATES - 5), 1e-8])
    mean = np.zeros(STATES)
    mean[2], mean[DRIFT] = 1.0, 4e-4
    cloud = MapParticleFilter(mean, covariance, 1)
    before, spread = cloud.moments()
    cloud.scale_drift(0.5)
    after, narrowed = cloud.moments()
    assert after[DRIFT] == pytest.approx(0.5 * before[DRIFT])
    assert narrowed[DRIFT, DRIFT] == pytest.approx(0.25 * spread[DRIFT, DRIFT])
    assert after[:DRIFT] == pytest.approx(before[:DRIFT])
