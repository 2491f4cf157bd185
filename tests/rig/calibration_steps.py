"""Steps of a calibration with simulated samples, for its tests."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TypeVar

from edge.calibration.model import Calibration
from edge.calibration.procedure import solve, take
from edge.samples import SensorBatch

T = TypeVar("T")
MADE = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)


def gathered(step, batches):
    """The step with all of these in it; raises where it does not do."""
    take(step, (SensorBatch(batch) for batch in batches))
    return step


def solved(*steps) -> Calibration:
    return solve(steps, "u1", "s", MADE)


def known(part: T | None) -> T:
    assert part is not None
    return part
