"""Heel strikes shorter than the response of the sensor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.foot.config import EskfConfig, FloorConfig, ProcessNoiseConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from tests.rig.inertial_walk import inertial_samples

LEGS = (Stand(4.0), Walk(((50.0, 0.0), (0.0, 0.0))), Stand(2.0))
STRIKE_MPS = 0.2  # of velocity, up or down, that a strike leaves in the samples


def track(description, imu, config):
    tracker = EskfTracker(description, config)
    return join_rows([tracker.push(imu), tracker.finish()])


def struck(imu, rows, rng):
    """The same with a sample too high or too low just before each stance, along gravity."""
    landings = np.flatnonzero(np.diff(rows.stationary.astype(int)) > 0) - 2
    landings = landings[imu.t_ns[landings] > imu.t_ns[0] + 4_000_000_000]
    period_s = float(np.median(np.diff(imu.t_ns))) * 1e-9
    resting = imu.accel_mps2[:200].mean(axis=0)
    accel_mps2 = imu.accel_mps2.copy()
    pushes_mps2 = rng.normal(STRIKE_MPS / 2, STRIKE_MPS, len(landings)) / period_s
    accel_mps2[landings] += pushes_mps2[:, None] * resting / np.linalg.norm(resting)
    return replace(imu, accel_mps2=accel_mps2)


def rms_rise_m(rows):
    """Rise of one foothold above the one before, on a flat floor."""
    footfalls = np.flatnonzero(np.diff(rows.steps) > 0)
    return float(np.sqrt(np.mean(np.diff(rows.position_n_m[footfalls, 2]) ** 2)))


def clipped(description, imu):
    """The same by a gyroscope that hides the fastest tenth of most swings, and says so."""
    full_scale = 0.9 * float(np.abs(imu.gyro_radps).max())
    reported = replace(description, gyro_full_scale_radps=full_scale)
    return reported, replace(imu, gyro_radps=np.clip(imu.gyro_radps, -full_scale, full_scale))


@pytest.mark.parametrize("clips", [False, True])
@pytest.mark.parametrize("seed", [1, 2])
def test_heel_strike_is_corrected_without_changing_the_swing(seed, clips):
    simulation = Simulation(Scenario("strikes", "heel strikes", LEGS), seed)
    imu = inertial_samples(simulation)
    no_floor = EskfConfig(floor=FloorConfig(gate_m=0.0, gate_slope=0.0, gate_stds=0.0))
    description = simulation.description
    hard = struck(imu, track(description, imu, no_floor), np.random.default_rng(seed))
    if clips:
        description, hard = clipped(description, hard)
    by_swing_m, by_strike_m = (
        rms_rise_m(track(description, hard, no_floor._replace(process=process)))
        for process in (ProcessNoiseConfig(curvature_noise_per_strike=0.0), no_floor.process)
    )
    assert by_swing_m > 0.05
    assert by_strike_m < 0.7 * by_swing_m
