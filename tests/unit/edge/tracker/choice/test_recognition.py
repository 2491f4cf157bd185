"""Place of a sensor on the body, recognised from its motion."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.simulation.factory import open_simulation
from edge.tracker.choice.recognition import MountRecogniser


def samples(worn_on: str, scenario: str = "straight") -> ImuBatch:
    simulation = open_simulation(f"{scenario}?seed=4&worn_on={worn_on}")
    parts = [batch.imu for batch in islice(simulation.batches(0.5), 60)]
    return ImuBatch(
        np.concatenate([one.t_ns for one in parts]),
        np.vstack([one.accel_mps2 for one in parts]),
        np.vstack([one.gyro_radps for one in parts]),
    )


def recognised(imu: ImuBatch, rows_at_once: int = 100) -> MountRecogniser:
    recogniser = MountRecogniser()
    for first in range(0, len(imu), rows_at_once):
        recogniser.push(imu.part(slice(first, first + rows_at_once)))
    return recogniser


@pytest.mark.parametrize(
    ("worn_on", "scenario", "place"),
    [
        ("foot", "straight", "foot"),
        ("foot", "search-ground-floor", "foot"),
        ("shank", "straight", "leg"),
        ("pocket", "straight", "leg"),
        ("hip", "search-ground-floor", "upper_body"),
        ("waist", "straight", "upper_body"),
        ("chest", "search-ground-floor", "upper_body"),
    ],
)
def test_simulated_walkers_show_where_they_wear_it(worn_on: str, scenario: str, place: str) -> None:
    assert recognised(samples(worn_on, scenario)).place == place


def test_the_batching_changes_nothing() -> None:
    imu = samples("chest")
    one, other = recognised(imu, 7), recognised(imu, 1000)
    assert (one.place, one.moved_ns) == (other.place, other.moved_ns)


def test_stirring_without_a_step_is_no_walk() -> None:
    """A unit that is turned over in the hands, then lies there."""
    t_s = np.arange(0.0, 60.0, 0.01)
    turning = np.where(t_s < 10.0, 1.5, 0.0)
    gyro = np.column_stack((turning, 0.1 * turning, 0.0 * turning))
    force = np.tile([0.0, 0.0, 9.81], (len(t_s), 1))
    recogniser = recognised(ImuBatch(np.rint(t_s * 1e9).astype(np.int64), force, gyro))
    assert recogniser.place is None
    assert recogniser.moved_ns is None, "nobody is kept from being located"
