"""A search with a compass, and fields that steel has bent."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import msgspec
import numpy as np

from edge.samples import ImuBatch
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import Simulation

SEEDS = (0, 1, 3)
DURATION_S = 240.0


@cache
def simulated(seed, building=False):
    """Samples and true attitudes of a search."""
    scenario = next(entry for entry in SCENARIOS if entry.name == "search-ground-floor")
    scenario = msgspec.structs.replace(scenario, duration_s=DURATION_S, building=building)
    simulation = Simulation(scenario, seed)
    batches = [batch.imu for batch in simulation.batches(1.0)]
    imu = ImuBatch(
        *(
            np.concatenate([getattr(batch, name) for batch in batches])
            for name in ("t_ns", "accel_mps2", "gyro_radps", "mag_ut")
        )
    )
    truth = simulation.truth(np.asarray(imu.t_ns * 1e-9, dtype=np.float64))
    return simulation.description, imu, truth


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def bent(imu, truth, seed, wave_m, bend_ut):
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
    return replace(imu, mag_ut=imu.mag_ut + bend_b_ut)


def random_directions(noise, count):
    directions = noise.standard_normal((count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)
