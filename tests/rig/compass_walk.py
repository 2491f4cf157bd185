"""A search with a compass, and fields that steel has bent."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.simulation.kinematics import Motion
from tests.rig.inertial_walk import inertial_walk

SEEDS = (0, 1, 3)
DURATION_S = 240.0


@cache
def searched(seed: int, building: bool = False) -> tuple[SensorDescription, ImuBatch, Motion]:
    """Return samples and true motion of a search, without a barometer."""
    found = inertial_walk("search-ground-floor", seed, duration_s=DURATION_S, building=building)
    return found.description, found.sensed("mag_ut"), found.truth


def bent(
    imu: ImuBatch, truth: Motion, seed: int, wave_m: tuple[float, float], bend_ut: float
) -> ImuBatch:
    """The field bent by that much (root mean square, each axis) in waves of such lengths."""
    noise = np.random.default_rng(seed)
    waves = (
        2.0
        * np.pi
        / noise.uniform(wave_m[0], wave_m[1], size=(12, 1))
        * random_directions(noise, 12)
    )
    phases = noise.uniform(0.0, 2.0 * np.pi, 12)
    amplitudes_ut = noise.normal(0.0, bend_ut / np.sqrt(6.0), (12, 3))
    bend_n_ut = np.sin(truth.position_n_m @ waves.T + phases) @ amplitudes_ut
    bend_b_ut = np.einsum("nji,nj->ni", truth.rotation_nb, bend_n_ut)
    assert imu.mag_ut is not None
    return replace(imu, mag_ut=imu.mag_ut + bend_b_ut)


def random_directions(noise: np.random.Generator, count: int) -> Floats:
    directions = noise.standard_normal((count, 3))
    units: Floats = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return units
