"""Selection of a tracker for the sensors of a person, and errors where none fits."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.choice import selection
from edge.tracker.choice.selection import TrackerSelection, select_automatically, select_named
from edge.tracker.interface import BodyDimensions, MultiSensorTrackerEntry
from shared.errors import ConfigError


def worn(*places: str, mag: bool = False) -> dict[str, SensorDescription]:
    """Sensors at these places, named a, b, c ..."""
    return {
        "abcd"[number]: SensorDescription("imu", 100.0, mag_present=mag, place=place)
        for number, place in enumerate(places)
    }


def no_tracker(sensors, dimensions):
    raise AssertionError("nothing is made here")


@pytest.fixture(autouse=True)
def one_tracker_of_two(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = MultiSensorTrackerEntry("pair", "", no_tracker, (("chest", "waist"), ("shank",)))
    monkeypatch.setattr(selection, "MULTI_SENSOR_TRACKERS", (entry,))


@pytest.mark.parametrize(
    ("places", "tracker", "sensors"),
    [
        (["foot"], "eskf", ("a",)),
        (["left_foot"], "eskf", ("a",)),
        (["lower_back"], "body", ("a",)),
        (["hand"], "body", ("a",)),
        (["waist", "right_foot"], "eskf", ("b",)),
        (["shank", "chest"], "pair", ("a", "b")),
        (["lower_back", "shank"], "pair", ("a", "b")),
        (["hand", "chest", "shank"], "pair", ("b", "c")),
    ],
)
def test_places_choose_the_tracker(
    places: list[str], tracker: str, sensors: tuple[str, ...]
) -> None:
    selected = select_automatically(worn(*places), BodyDimensions(height_m=1.8))
    assert (selected.tracker, selected.sensors) == (tracker, sensors)
    assert bool(selected.notes) == (len(sensors) < len(places)), "nothing is left out in silence"


def test_a_named_tracker_takes_the_sensor_that_is_best_for_it() -> None:
    selected = select_named("hip", worn("foot", "waist", "hip", mag=True), BodyDimensions())
    assert selected.sensors == ("c",)
    assert selected.notes == ("tracker hip tracks by c; a and b is recorded only",)


def test_a_tracker_on_another_part_of_the_body_is_noted() -> None:
    (note,) = select_named("eskf", worn("chest"), BodyDimensions()).notes
    assert "made for foot" in note
    assert "worn on chest" in note


def test_a_compass_tracker_without_a_magnetometer_is_noted() -> None:
    (note,) = select_named("waist", worn("waist"), BodyDimensions()).notes
    assert "no magnetometer" in note
    assert select_named("waist", worn("waist", mag=True), BodyDimensions()).notes == ()


def test_the_wrong_sensors_are_tracked_by_another_tracker_and_that_is_noted() -> None:
    selected = select_named("pair", worn("chest", "hand"), BodyDimensions())
    assert (selected.tracker, selected.sensors) == ("body", ("a",))
    assert selected.notes[0] == (
        "tracker pair needs one sensor each at chest or waist and shank, and this unit has chest, "
        "hand: body tracks instead"
    )


def test_missing_leg_length_is_reported() -> None:
    (note,) = select_named("pair", worn("chest", "shank"), BodyDimensions()).notes
    assert "usual leg length" in note
    assert select_named("pair", worn("chest", "shank"), BodyDimensions(height_m=1.8)).notes == ()


def test_missing_leg_length_is_reported_where_the_places_choose_the_tracker() -> None:
    (note,) = select_named("by-place", worn("chest", "shank"), BodyDimensions()).notes
    assert "usual leg length" in note


@pytest.mark.parametrize(
    "dimensions",
    [
        BodyDimensions(leg_length_m=2.3),
        BodyDimensions(leg_length_m=95.0),  # centimetres
        BodyDimensions(height_m=1.95, leg_length_m=0.65),
        BodyDimensions(height_m=1.55, leg_length_m=1.1),
    ],
)
def test_a_leg_length_that_no_person_has_is_reported(dimensions: BodyDimensions) -> None:
    (note,) = select_named("pair", worn("chest", "shank"), dimensions).notes
    assert f"the leg length of {dimensions.leg_length_m:.2f} m fits no person" in note


@pytest.mark.parametrize("leg_m", [0.72, 0.87, 1.1])
def test_leg_lengths_of_people_are_not_reported(leg_m: float) -> None:
    dimensions = BodyDimensions(height_m=leg_m / 0.53, leg_length_m=leg_m)
    assert select_named("pair", worn("chest", "shank"), dimensions).notes == ()


def test_an_unknown_name_is_refused_with_those_known() -> None:
    with pytest.raises(ConfigError, match=r"no tracker 'foo'.*eskf.*pair.*auto"):
        select_named("foo", worn("foot"), BodyDimensions())


def test_only_a_tracker_of_one_sensor_needs_it_on_a_foot() -> None:
    assert TrackerSelection("eskf", ("a",)).foot_sensor == "a"
    assert TrackerSelection("body", ("a",)).foot_sensor is None
    assert TrackerSelection("pair", ("a", "b")).foot_sensor is None


def test_a_tracker_of_one_sensor_leaves_the_others_alone() -> None:
    sensors = worn("foot", "waist")
    tracker = TrackerSelection("eskf", ("a",)).make(sensors, BodyDimensions())
    rest = np.tile([0.0, 0.0, 9.81], (400, 1))
    imu = ImuBatch(np.arange(400) * 10_000_000, rest, np.zeros((400, 3)))
    assert len(tracker.push("b", imu)) == 0
    assert len(tracker.push("a", imu)) > 0
