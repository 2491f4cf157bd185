"""The process whose instructions ``tests.bench.tracker.instructions`` counts.

``python -m tests.bench.tracker.instruction_probe TRACKER SAMPLES.npz``: says ``ready``; then for
every number that comes in tracks so many samples and says ``done``.
"""

from __future__ import annotations

import sys

import numpy as np

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.registry import make_tracker


def main(name: str, file: str) -> None:
    with np.load(file) as columns:
        imu = ImuBatch(**columns)
    rate_hz = 1e9 / float(np.median(np.diff(imu.t_ns)))
    _say("ready")
    for line in sys.stdin:
        tracker = make_tracker(name, SensorDescription("counted", rate_hz))
        tracker.push(imu.part(slice(0, int(line))))
        _say("done")


def _say(word: str) -> None:
    sys.stdout.write(word + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
