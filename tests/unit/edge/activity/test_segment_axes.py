"""Axes of a trunk, learnt from recorded walks of people with a sensor on the lower back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from edge.activity.inclination import InclinationFilter
from edge.activity.segment_axes import SegmentAxes
from edge.samples import Floats
from edge.sources.recording import RecordingSource

BACK_B = np.array([0.0, 0.0, 1.0])  # all of them wear the sensor with this axis to the back
NEAR_COS = 0.8


def directions(recording: Path) -> list[Floats]:
    """Directions of the walk that are found, in sensor axes."""
    filtered, axes = InclinationFilter(), SegmentAxes("trunk")
    return [
        direction_b
        for batch in RecordingSource(recording).batches()
        for window in filtered.push(batch.imu)
        if (direction_b := axes.push(window)) is not None
    ]


@pytest.mark.slow
def test_recorded_walks_show_the_forward_axis(worn_elsewhere: tuple[Path, ...]) -> None:
    found = [
        directions(path) for path in sorted(worn_elsewhere[0].glob("ipol/*/lower_back.csv.gz"))
    ]
    assert len(found) >= 40
    assert np.mean([len(one) >= 2 for one in found]) > 0.95, "people whose walk is recognised"
    every = np.vstack([direction_b for one in found for direction_b in one])
    assert np.mean(every @ -BACK_B > NEAR_COS) > 0.9
