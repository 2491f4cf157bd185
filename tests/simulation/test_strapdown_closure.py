"""Ideal sensors, integrated, give the simulated truth back.

The integrator is a classical Runge-Kutta of fourth order, independent of the
product, which takes every second sample as its midpoint.
"""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace
from numba import njit

from edge.samples import Floats
from edge.simulation.factory import find_scenario
from edge.simulation.imu import GRAVITY_MPS2
from edge.simulation.legs import Segment
from edge.simulation.simulation import IDEAL_SENSORS, Simulation

RATE_HZ = 4000.0  # fine enough that the integrator's own error stays below a millimetre


@njit(fastmath=False)
def _slope(state: Floats, force: Floats, rate: Floats, slope: Floats) -> None:
    """Time derivative of position, velocity and quaternion (10,)."""
    w, x, y, z = state[6], state[7], state[8], state[9]
    p, q, r = rate[0], rate[1], rate[2]
    slope[0:3] = state[3:6]
    norm = w * w + x * x + y * y + z * z
    ux, uy, uz = force[0], force[1], force[2]
    tx, ty, tz = y * uz - z * uy, z * ux - x * uz, x * uy - y * ux
    slope[3] = ux + 2.0 * (w * tx + y * tz - z * ty) / norm
    slope[4] = uy + 2.0 * (w * ty + z * tx - x * tz) / norm
    slope[5] = uz + 2.0 * (w * tz + x * ty - y * tx) / norm + GRAVITY_MPS2
    slope[6] = 0.5 * (-x * p - y * q - z * r)
    slope[7] = 0.5 * (w * p + y * r - z * q)
    slope[8] = 0.5 * (w * q + z * p - x * r)
    slope[9] = 0.5 * (w * r + x * q - y * p)


@njit(fastmath=False)
def _integrate(state: Floats, force: Floats, rate: Floats, dt_s: float) -> Floats:
    """The state (10,) at the last of an odd number of samples."""
    k1, k2, k3, k4 = np.empty(10), np.empty(10), np.empty(10), np.empty(10)
    for j in range(0, len(force) - 2, 2):
        _slope(state, force[j], rate[j], k1)
        _slope(state + 0.5 * dt_s * k1, force[j + 1], rate[j + 1], k2)
        _slope(state + 0.5 * dt_s * k2, force[j + 1], rate[j + 1], k3)
        _slope(state + dt_s * k3, force[j + 2], rate[j + 2], k4)
        state = state + dt_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        state[6:10] /= np.sqrt(np.sum(state[6:10] ** 2))
    return state


def _quaternion(rotation_nb: Floats) -> Floats:
    """Quaternion of a matrix whose scalar part is clearly above zero."""
    w = 0.5 * np.sqrt(1.0 + np.trace(rotation_nb))
    skew = rotation_nb - rotation_nb.T
    return np.array([w, *(np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / (4.0 * w))])


@pytest.mark.parametrize(
    ("name", "worn_on", "duration_s"),
    [
        ("climbs-stairs", "foot", 600.0),
        ("gets-hot", "foot", 60.0),
        ("gaits", "foot", 90.0),
        ("gaits", "shank", 90.0),
        ("gaits", "hip", 90.0),
        ("climbs-stairs", "chest", 60.0),
        ("raised-feet", "foot", 40.0),
        ("changing-gaits", "foot", 30.0),
        ("dragged-foot", "pocket", 40.0),
    ],
)
def test_ideal_sensors_integrate_to_the_truth(
    name: str, worn_on: Segment, duration_s: float
) -> None:
    scenario = replace(
        find_scenario(name), rate_hz=RATE_HZ, duration_s=duration_s, worn_on=worn_on, conversions=1
    )
    simulation = Simulation(scenario, seed=3, sensors=IDEAL_SENSORS)
    start = simulation.truth(np.zeros(1))
    state = np.concatenate(
        (start.position_n_m[0], start.velocity_n_mps[0], _quaternion(start.rotation_nb[0]))
    )
    rest = np.empty((0, 6))
    done = 0
    positions, errors_m = [], []
    for batch in simulation.batches(batch_s=2.0):
        samples = np.vstack((rest, np.hstack((batch.imu.accel_mps2, batch.imu.gyro_radps))))
        used = (len(samples) - 1) // 2 * 2
        state = _integrate(state, samples[: used + 1, :3], samples[: used + 1, 3:], 2.0 / RATE_HZ)
        rest, done = samples[used:], done + used
        truth = simulation.truth(np.array([done / RATE_HZ])).position_n_m[0]
        positions.append(truth)
        errors_m.append(np.linalg.norm(state[:3] - truth))
        if done >= duration_s * RATE_HZ:
            break
    assert np.ptp(positions, axis=0).min() > 0.01, "the walk moves along every axis"
    assert max(errors_m) < 2e-3
