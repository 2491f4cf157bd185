"""A trunk that walks evenly, in closed form: for tests of trackers that count steps.

Vertical acceleration is one cosine a step; the forward part is in phase with the downward velocity,
as a trunk's is, or with the upward acceleration, as that of a hand is.  Axes: forward, right, down.
"""

from __future__ import annotations

import numpy as np

from edge.samples import Floats, ImuBatch

GRAVITY_MPS2 = 9.80665
RATE_HZ = 100.0


def still(seconds: float, rate_z_radps: float = 0.0) -> Floats:
    """Samples (n, 6) of somebody who stands: force, rate."""
    samples = np.zeros((round(seconds * RATE_HZ), 6))
    samples[:, 2] = -GRAVITY_MPS2
    samples[:, 5] = rate_z_radps
    return samples


def steps(
    count: int,
    step_s: float = 0.55,
    up_mps2: float = 2.0,
    falling: float = 0.6,
    rising: float = 0.0,
    rate_z_radps: float = 0.0,
    forward_rad: float = 0.0,
) -> Floats:
    """Samples (n, 6) of steps; ``falling`` and ``rising``: the forward part, by the vertical one.

    ``forward_rad``: where forward is, clockwise from the sensor's own axis.
    """
    samples = still(count * step_s, rate_z_radps)
    phase = 2.0 * np.pi * np.arange(len(samples)) / RATE_HZ / step_s
    up, fall = up_mps2 * np.cos(phase), -up_mps2 * np.sin(phase)
    forward = falling * fall + rising * up
    samples[:, 0] = np.cos(forward_rad) * forward
    samples[:, 1] = np.sin(forward_rad) * forward
    samples[:, 2] -= up
    return samples


def imu(*parts: Floats, mag_n_ut: tuple[float, float, float] | None = None) -> ImuBatch:
    """Join parts to one batch.  ``mag_n_ut``: the field around, turned by the rates as if true."""
    samples = np.vstack(parts)
    noise = np.random.default_rng(1)  # without any a sensor counts as stuck
    samples += noise.normal(0.0, (0.02,) * 3 + (0.002,) * 3, samples.shape)
    t_ns = np.rint(np.arange(len(samples)) / RATE_HZ * 1e9).astype(np.int64)
    mag_ut = None
    if mag_n_ut is not None:
        north, east, down = mag_n_ut
        mag_ut = np.tile([north, east, down], (len(samples), 1))
    return ImuBatch(t_ns, samples[:, :3].copy(), samples[:, 3:].copy(), mag_ut)
