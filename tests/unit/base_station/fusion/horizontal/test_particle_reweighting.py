"""A cloud of particles that is reweighted to a posterior keeps the evidence of walls."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from base_station.fusion.horizontal.map_particle_filter import MapParticleFilter
from base_station.fusion.horizontal.particles import PARTICLES

MEAN = np.eye(9)[2]
SPREAD = np.diag([4.0, 0.01, 1e-4, 1e-4, *[1e-6] * 4, 1e-10])


@pytest.fixture
def cloud() -> MapParticleFilter:
    """Particles on both sides of a wall along north 0, and none within a metre of it."""
    begun = MapParticleFilter(MEAN, SPREAD, 5).save()
    states = np.frombuffer(begun.particles.states).reshape(PARTICLES, 5).copy()
    states[:, 0] += np.where(states[:, 0] > 0.0, 1.0, -1.0)
    particles = msgspec.structs.replace(begun.particles, states=states.tobytes())
    return MapParticleFilter.restore(msgspec.structs.replace(begun, particles=particles))


def is_reweighted(cloud: MapParticleFilter, north_m: float, std_m: float) -> bool:
    mean, covariance = cloud.moments()
    known = [0, 1, 2, 3, 8]
    mean, covariance = mean[known], covariance[np.ix_(known, known)]
    mean[0], covariance[0, 0] = north_m, std_m**2
    covariance[0, 1:] = covariance[1:, 0] = 0.0
    return cloud.reweight_to(mean, covariance)


def norths(cloud: MapParticleFilter) -> np.ndarray:
    return np.frombuffer(cloud.save().particles.states).reshape(PARTICLES, 5)[:, 0]


def test_posterior_like_the_cloud_changes_little(cloud: MapParticleFilter) -> None:
    (before, spread), std_m = cloud.moments(), float(np.sqrt(cloud.moments()[1][0, 0]))
    assert is_reweighted(cloud, float(before[0]), std_m)
    after, again = cloud.moments()
    assert after[0] == pytest.approx(before[0], abs=0.1 * std_m)
    assert again[0, 0] == pytest.approx(spread[0, 0], rel=0.1)


def test_posterior_on_one_side_leaves_the_wall_free(cloud: MapParticleFilter) -> None:
    """A normal distribution would put a third of itself into the wall."""
    assert is_reweighted(cloud, 1.2, 1.0)
    assert np.mean(norths(cloud) > 0.8) > 0.95
    assert cloud.moments()[0][0] > 1.0


def test_posterior_elsewhere_is_refused_and_changes_nothing(cloud: MapParticleFilter) -> None:
    before = cloud.save()
    assert not is_reweighted(cloud, 40.0, 0.5)
    assert cloud.save() == before
