"""A trunk that bobs at every step, in closed form: for tests of the trackers of the trunk."""

from __future__ import annotations

import numpy as np

from edge.samples import ImuBatch, SensorDescription

GRAVITY_MPS2 = 9.80665
UPRIGHT = np.array([0.0, 0.0, -GRAVITY_MPS2])  # what an upright sensor feels, z down
DESCRIPTION = SensorDescription("bobbing", 100.0)


def bobbing(
    steps: int,
    frequency_hz: float,
    amplitude_mps2: float = 2.5,
    turn_radps: float = 0.0,
    rate_hz: float = 100.0,
    stands_s: float = 2.0,
) -> ImuBatch:
    """Stand, bob up and down once a step (and turn meanwhile), stand again."""
    walk_s = steps / frequency_hz
    t_s = np.arange(0.0, walk_s + 2.0 * stands_s, 1.0 / rate_hz)
    since_s = t_s - stands_s
    walking = (since_s >= 0.0) & (since_s < walk_s)
    bob_mps2 = amplitude_mps2 * np.sin(2.0 * np.pi * frequency_hz * since_s) * walking
    accel_mps2 = np.outer(1.0 + bob_mps2 / GRAVITY_MPS2, UPRIGHT)
    gyro_radps = np.zeros((len(t_s), 3))
    gyro_radps[:, 2] = turn_radps * walking
    gyro_radps += np.random.default_rng(1).normal(0.0, 1e-3, gyro_radps.shape)  # or it seems stuck
    return ImuBatch(np.rint(t_s * 1e9).astype(np.int64), accel_mps2, gyro_radps)


def joined(*parts: ImuBatch) -> ImuBatch:
    """Return walks one after the other."""
    times_ns, begin_ns = [], 0
    for part in parts:
        times_ns.append(part.t_ns + begin_ns)
        begin_ns = int(times_ns[-1][-1] + part.t_ns[1] - part.t_ns[0])
    return ImuBatch(
        np.concatenate(times_ns),
        np.concatenate([part.accel_mps2 for part in parts]),
        np.concatenate([part.gyro_radps for part in parts]),
    )
