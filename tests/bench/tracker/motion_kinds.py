"""Kind of motion of a walk: of a simulated one by its scenario, of a recorded one by its samples.

No recording has a label.  What tells them apart is how fast the foot turns at most, and how long a
stride takes: feet that are put down slowly turn at 1 rad/s, those of walkers at 5 to 8, of runners
at 8 to 10 and of sprinters at more; who crawls takes longer for a stride than any walker.
"""

from __future__ import annotations

import numpy as np

from edge.samples import ImuBatch
from tests.bench.tracker.constant_walks import SIMULATED, Walk

SCENARIOS = {
    "raised-feet": "raised feet",
    "careful-steps": "careful steps",
    "dragged-foot": "dragged foot",
    "changing-gaits": "changing gaits",
    "sprint-800hz": "sprinting",
    "sprint-500dps": "sprinting",
    "run-100hz": "running",
    "stairs-500hz": "stairs",
}
# Below this rate (rad/s, exceeded by a twentieth of the samples).
RECORDINGS = (
    (1.5, "raised feet"),
    (5.0, "turning on the spot"),
    (8.0, "walking"),
    (9.5, "running"),
)
FASTEST = "sprinting"
CRAWLS = ("walking", "crawling")  # as fast; which of them the stride tells
CRAWL_STRIDE_S = 1.5
STRIDES_S = (0.4, 2.5)


def motion_of(walk: Walk) -> str:
    """Return the kind of motion, such as ``walking``."""
    if walk.kind == SIMULATED:
        return SCENARIOS[walk.name]
    rate_radps = np.linalg.norm(walk.imu.gyro_radps, axis=1)
    fast_radps = float(np.quantile(rate_radps, 0.95))
    motion = next((name for below, name in RECORDINGS if fast_radps < below), FASTEST)
    if motion == CRAWLS[0] and stride_s(walk.imu) > CRAWL_STRIDE_S:
        return CRAWLS[1]
    return motion


def stride_s(imu: ImuBatch) -> float:
    """Return the duration of a stride (s): the lag at which the rate is most like itself."""
    rate_radps = np.linalg.norm(imu.gyro_radps, axis=1)
    period_s = float(np.median(np.diff(imu.t_ns))) * 1e-9
    spectrum = np.fft.rfft(rate_radps - rate_radps.mean(), 2 * len(rate_radps))
    likeness = np.fft.irfft(np.abs(spectrum) ** 2)
    first, stop = (round(lag_s / period_s) for lag_s in STRIDES_S)
    return (first + int(np.argmax(likeness[first:stop]))) * period_s
