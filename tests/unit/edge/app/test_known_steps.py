"""Steps of a person in a recording that is tracked again: found beside it, and named in words."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.step_learning import WALK_STD
from edge.app.known_steps import known_steps, steps_used
from edge.app.tracking import tracking_of
from edge.config import EdgeConfig
from edge.samples import SensorDescription
from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale
from shared.errors import RecordingError

LEARNT = StepScale(1.08, 0.04)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Folder of a unit that has learnt of one person."""
    StepScales(tmp_path / "step_scales.json", "Ada").save({"chest": LEARNT})
    return tmp_path


def used(
    tracker: str, places: Mapping[str, str], person: str, known: Mapping[str, StepScale]
) -> str:
    sensors = [
        FittedSensor(SensorDescription("s", 100.0, place=place), name=name)
        for name, place in places.items()
    ]
    tracking = tracking_of(EdgeConfig("mcap:x", tracker=tracker), sensors, known)
    return steps_used(tracking.name, tracking.tracker, person, known)


def test_a_walk_starts_as_it_would_on_the_unit(folder: Path) -> None:
    start = known_steps("Ada", (folder,))["chest"]
    assert start.factor == LEARNT.factor
    assert start.std == pytest.approx((LEARNT.std**2 + WALK_STD**2) ** 0.5)


def test_a_file_beside_the_boots_comes_before_that_of_the_unit(folder: Path) -> None:
    beside = folder / "black_box"
    beside.mkdir()
    assert known_steps("Ada", (beside, folder)).keys() == {"chest"}
    StepScales(beside / "step_scales.json", "Ada").save({"hip": LEARNT})
    assert known_steps("Ada", (beside, folder)).keys() == {"hip"}


def test_no_person_needs_no_file(tmp_path: Path) -> None:
    assert known_steps("", (tmp_path,)) == {}


def test_a_person_of_whom_nothing_is_known_is_refused(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="nothing on the steps of 'Ben'"):
        known_steps("Ben", (folder,))
    with pytest.raises(RecordingError, match=r"step_scales\.json.* is not in .*elsewhere"):
        known_steps("Ada", (tmp_path / "neither", tmp_path / "elsewhere"))


@pytest.mark.parametrize("content", [b"", b"\0" * 40, b'{"people": {"x": {"hip": {"std": 1}}}}'])
def test_a_damaged_file_is_refused_and_left_as_it_is(folder: Path, content: bytes) -> None:
    file = folder / "step_scales.json"
    file.write_bytes(content)
    with pytest.raises(RecordingError, match="cannot be read"):
        known_steps("Ada", (folder,))
    assert [(one.name, one.read_bytes()) for one in folder.iterdir()] == [(file.name, content)]


def test_steps_of_the_person_are_named_with_how_well_they_are_known() -> None:
    text = used("body", {"": "chest"}, "Ada", {"chest": StepScale(1.08, 0.0544)})
    assert "steps of Ada, sensor at chest: 1.080 of the usual length, known to 5.4 %" in text
    assert "this walk and later ones may be among those" in text


def test_steps_of_people_in_the_mean_are_named() -> None:
    text = used("body", {"": "chest"}, "", {})
    assert text == (
        "steps of people in the mean, sensor at chest; --person takes what the unit has learnt of "
        "its wearer's"
    )


def test_steps_at_another_place_of_the_body_are_not_used() -> None:
    text = used("body", {"": "hip"}, "Ada", {"chest": LEARNT})
    assert text == (
        "steps of people in the mean, sensor at hip: of Ada they are known of a sensor at chest"
    )


@pytest.mark.parametrize(
    ("tracker", "places"),
    [
        ("eskf", {"": "foot"}),
        ("waist", {"": "waist"}),
        ("two_feet", {"left": "left_foot", "right": "right_foot"}),
    ],
)
def test_tracker_without_lengths_of_steps_is_reported(tracker: str, places: dict[str, str]) -> None:
    known = {"foot": LEARNT, "waist": LEARNT}
    assert used(tracker, places, "Ada", known) == (
        f"tracker {tracker} takes no path from lengths of steps"
    )


def test_the_trunk_beside_a_foot_starts_with_the_persons_steps() -> None:
    places = {"foot": "left_foot", "back": "chest"}
    assert "steps of Ada, sensor at chest: 1.080" in used(
        "foot_and_trunk", places, "Ada", {"chest": LEARNT}
    )
    assert "people in the mean, sensor at chest" in used("foot_and_trunk", places, "", {})
