"""A tracker that chooses itself: the right tracker, and no part of the path lost."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.simulation.factory import open_simulation
from edge.tracker.choice.automatic import AutomaticTracker
from edge.tracker.interface import BodyDimensions, TrackBatch
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows

BATCH_S = 0.5


def walk(worn_on: str, long_s: float = 30.0) -> tuple[SensorDescription, list[ImuBatch]]:
    simulation = open_simulation(f"search-ground-floor?seed=4&worn_on={worn_on}")
    batches = [batch.imu for batch in simulation.batches(BATCH_S)]
    return simulation.description, batches[: round(long_s / BATCH_S)]


def alone(name: str, description: SensorDescription, batches: list[ImuBatch]) -> TrackBatch:
    tracker = make_tracker(name, description)
    return join_rows([*(tracker.push(batch) for batch in batches), tracker.finish()])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("worn_on", "name", "place"),
    [("foot", "eskf", "foot"), ("chest", "body", "upper_body")],
)
def test_the_rows_are_those_of_the_tracker_that_is_right(
    worn_on: str, name: str, place: str
) -> None:
    description, batches = walk(worn_on)
    tracker = AutomaticTracker({"": description}, BodyDimensions())
    rows = join_rows([*(tracker.push("", batch) for batch in batches), tracker.finish()])
    assert tracker.choice is not None
    assert (tracker.choice.tracker, tracker.choice.recognised) == (name, {"": place})
    assert tracker.choice.foot_sensor == ("" if worn_on == "foot" else None)
    expected = alone(name, description, batches)
    assert rows.t_ns.tolist() == expected.t_ns.tolist(), "each sample has its row, once"
    moving = rows.distance_m > 1.0
    for field in fields(TrackBatch):
        found, wanted = getattr(rows, field.name), getattr(expected, field.name)
        np.testing.assert_array_equal(found[moving], wanted[moving], field.name)
    assert rows.distance_m[-1] > 5.0


@pytest.mark.slow
def test_a_unit_that_lies_still_is_located_at_once() -> None:
    rest = np.tile([0.0, 0.0, 9.81], (500, 1))
    tracker = AutomaticTracker({"": SensorDescription("imu", 100.0)}, BodyDimensions())
    imu = ImuBatch(np.arange(500) * 10_000_000, rest, np.zeros((500, 3)))
    rows = [tracker.push("", imu.part(slice(k, k + 10))) for k in range(0, 500, 10)]
    assert sum(map(len, rows)) > 300
    assert tracker.choice is None


@pytest.mark.slow
def test_a_sensor_that_never_comes_is_not_waited_for() -> None:
    description, batches = walk("foot")
    sensors = {"gone": description, "there": description}
    tracker = AutomaticTracker(sensors, BodyDimensions())
    rows = join_rows([tracker.push("there", batch) for batch in batches])
    assert tracker.choice is not None
    assert tracker.choice.recognised == {"there": "foot"}
    assert rows.distance_m[-1] > 5.0
