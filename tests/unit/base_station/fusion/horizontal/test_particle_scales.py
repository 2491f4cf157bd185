"""Every particle has a scale of its own, which walls teach, and which old states lack."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.horizontal.map_particle_filter import MapParticleFilter
from base_station.fusion.horizontal.particles import PARTICLES
from base_station.fusion.kernels import STATES
from base_station.site.floor_grid import FloorGrid
from tests.rig.walled_plan import walled_grid

CORRIDOR_M, LONG_M, CROSS_M = 2.0, 34.0, 30.0
NOISE = 0.03**2, 0.004**2
SCALE_STD = 0.1


def bent_corridor() -> FloorGrid:
    """Thirty metres to the north, then to the east; as wide as the corridor."""
    lines = [
        [[0.0, 0.0], [0.0, CROSS_M + CORRIDOR_M], [40.0, CROSS_M + CORRIDOR_M]],
        [[CORRIDOR_M, 0.0], [CORRIDOR_M, CROSS_M], [40.0, CROSS_M]],
    ]
    ring = [[-1.0, -1.0], [41.0, -1.0], [41.0, LONG_M], [-1.0, LONG_M], [-1.0, -1.0]]
    return walled_grid(ring, lines)


def begun() -> MapParticleFilter:
    mean, covariance = np.zeros(STATES), np.zeros((STATES, STATES))
    mean[[0, 1, 2]] = 1.0, 0.5 * CORRIDOR_M, 1.0
    covariance[[0, 1], [0, 1]] = 0.2**2
    covariance[2, 2] = SCALE_STD**2
    covariance[[3, 4, 5, 6, 7], [3, 4, 5, 6, 7]] = 0.01**2, 1.0, 1.0, 1.0, 1.0
    return MapParticleFilter(mean, covariance, 1)


def scale_and_std(cloud: MapParticleFilter) -> tuple[float, float]:
    mean, covariance = cloud.moments()
    along = mean[2:4] / np.linalg.norm(mean[2:4])
    return float(np.linalg.norm(mean[2:4])), math.sqrt(along @ covariance[2:4, 2:4] @ along)


@pytest.mark.parametrize("true_scale", [0.9, 1.1])
def test_corridor_that_bends_teaches_the_scale(true_scale: float) -> None:
    """Thirty metres to a corridor that is two metres wide: 3 % at the best."""
    cloud, grid = begun(), bent_corridor()
    steps = round((CROSS_M + 0.5 * CORRIDOR_M - 1.0) / (0.5 * true_scale))
    for _ in range(steps):
        cloud.predict((0.5, 0.0, 0.5, 0.0), NOISE, grid, 0)
    for _ in range(30):
        cloud.predict((0.0, 0.5, 0.5, 0.0), NOISE, grid, 0)
    scale, std = scale_and_std(cloud)
    assert scale == pytest.approx(true_scale, abs=0.05)
    assert std < 0.65 * SCALE_STD  # a crossing is a door that is not drawn, in one of fifty


def test_way_without_a_bend_leaves_the_scale_open() -> None:
    cloud, grid = begun(), bent_corridor()
    for _ in range(30):
        cloud.predict((0.5, 0.0, 0.5, 0.0), NOISE, grid, 0)
    _, std = scale_and_std(cloud)
    assert std == pytest.approx(SCALE_STD, rel=0.25)


def test_state_of_before_has_the_scale_of_then_and_its_deviation() -> None:
    saved = begun().save()
    states = np.frombuffer(saved.particles.states).reshape(PARTICLES, 5)
    then = msgspec.structs.replace(
        saved.particles, states=states[:, :4].tobytes(), scale=1.07, scale_var=0.03**2
    )
    restored = MapParticleFilter.restore(msgspec.structs.replace(saved, particles=then))
    scale, std = scale_and_std(restored)
    assert scale == pytest.approx(1.07, abs=0.01)
    assert std == pytest.approx(0.03, rel=0.1)
    assert MapParticleFilter.restore(restored.save()).save() == restored.save()
