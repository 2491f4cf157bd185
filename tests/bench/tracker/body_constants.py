"""Fit of the step lengths of ``body``: ``python -m tests.bench.tracker.body_constants DATA``.

The length of a step is proportional to its constant, so the geometric mean of tracked by true
lengths over people corrects it.  Prints what ``BodyConfig`` has and what it should have.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from edge.tracker.body.config import BodyConfig
from tests.bench.tracker.body_recordings import left_out_errors, phone_length_ratios, track_back


def _mean(ratios: list[float]) -> float:
    return float(np.exp(np.mean(np.log(ratios))))


def main(data: Path) -> None:
    config = BodyConfig()
    walks = [
        track_back(path, "body") for path in sorted(data.glob("body/ipol/*/lower_back.csv.gz"))
    ]
    people = sorted({walk.person for walk in walks})
    by_person = [
        _mean([walk.length_ratio for walk in walks if walk.person == person]) for person in people
    ]
    trunk = config.trunk_scale_m / _mean(by_person)
    print(f"trunk_scale_m: is {config.trunk_scale_m:.3f}, fitted {trunk:.3f}")
    print(f"scale_std of people: {np.std(np.log(by_person), ddof=1):.3f}")
    print(f"left out, median: {np.median(left_out_errors(walks, fitted=True)):.3f}")
    hand = config.hand_scale_m / _mean(phone_length_ratios(data, "body"))
    print(f"hand_scale_m: is {config.hand_scale_m:.3f}, fitted {hand:.3f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
