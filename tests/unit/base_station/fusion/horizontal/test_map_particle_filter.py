"""Map particle filter: half a body keeps off a wall."""

from __future__ import annotations

import math

import numpy as np

from base_station.fusion.horizontal.map_particle_filter import MapParticleFilter
from base_station.fusion.kernels import STATES
from base_station.site.floor_grid import FloorGrid
from tests.rig.walled_plan import walled_grid

CORRIDOR_M, LONG_M = 2.0, 30.0
NOISE = 0.03**2, 0.004**2
HAND_NOISE = 0.28**2, 0.014**2
SCALE_STD = 0.015


def corridor() -> FloorGrid:
    """From south to north; its west wall lies on east 0."""
    lines = [[[0.0, 0.0], [0.0, LONG_M]], [[CORRIDOR_M, 0.0], [CORRIDOR_M, LONG_M]]]
    ring = [[0.0, 0.0], [CORRIDOR_M, 0.0], [CORRIDOR_M, LONG_M], [0.0, LONG_M], [0.0, 0.0]]
    return walled_grid(ring, lines)


def walked_north(
    east_m: float, std_m: float, noise: tuple[float, float] = NOISE
) -> MapParticleFilter:
    """Fifteen metres along the corridor, from the assumed start."""
    mean, covariance = np.zeros(STATES), np.zeros((STATES, STATES))
    mean[[0, 1, 2]] = 5.0, east_m, 1.0
    covariance[[0, 1], [0, 1]] = std_m**2
    covariance[2, 2] = SCALE_STD**2
    covariance[[3, 4, 5, 6, 7], [3, 4, 5, 6, 7]] = 0.01**2, 1.0, 1.0, 1.0, 1.0
    cloud, grid = MapParticleFilter(mean, covariance, 1), corridor()
    for _ in range(30):
        cloud.predict((0.5, 0.0, 0.5, 0.0), noise, grid, 0)
    return cloud


def test_particles_keep_half_a_body_width_from_a_wall() -> None:
    cloud = walked_north(0.4, 0.25)
    mean, covariance = cloud.moments()
    assert 0.58 < mean[1] < 0.8
    assert math.sqrt(covariance[1, 1]) < 0.32


def test_path_close_to_a_wall_is_no_evidence_against_the_plan() -> None:
    assert not walked_north(0.1, 0.05).is_contradicted


def test_place_beside_a_wall_costs_a_noisy_path_less() -> None:
    foot, hand = walked_north(0.15, 0.02), walked_north(0.15, 0.02, HAND_NOISE)
    first = [cloud.save().window[0].log_beside for cloud in (foot, hand)]
    assert math.exp(first[0]) < 0.56
    assert math.exp(first[1]) > 0.75
