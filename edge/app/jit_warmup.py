"""Compilation of the trackers' kernels before an agent needs them: half a minute once, then
cached.
"""

from __future__ import annotations

import numpy as np

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.registry import TRACKERS

_STILL = ImuBatch(
    t_ns=np.arange(300) * 10_000_000,
    accel_mps2=np.tile([0.0, 0.0, 9.81], (300, 1)),
    gyro_radps=np.zeros((300, 3)),
)


def compile_trackers() -> None:
    """Run every tracker over three seconds of stillness."""
    for entry in TRACKERS:
        tracker = entry.make(SensorDescription(name="still", rate_hz=100.0))
        tracker.push(_STILL)
        tracker.finish()
