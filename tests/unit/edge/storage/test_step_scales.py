"""Learnt lengths of steps on disk: kept over restarts, and of one person each."""

from __future__ import annotations

from pathlib import Path

import pytest

from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale

LONG, SHORT = StepScale(1.15, 0.03), StepScale(0.9, 0.04)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "step_scales.json"


def test_a_scale_outlives_a_restart(path: Path) -> None:
    StepScales(path, "Ada").save({"chest": LONG})
    assert StepScales(path, "Ada").learnt == {"chest": LONG}


def test_scales_of_two_people_and_two_places_are_never_mixed(path: Path) -> None:
    StepScales(path, "Ada").save({"chest": LONG})
    assert StepScales(path, "Ben").learnt == {}
    StepScales(path, "Ben").save({"chest": SHORT})
    StepScales(path, "Ada").save({"hip": SHORT})
    assert StepScales(path, "Ada").learnt == {"chest": LONG, "hip": SHORT}
    assert StepScales(path, "Ben").learnt == {"chest": SHORT}


def test_nothing_is_kept_of_a_wearer_who_is_not_known(path: Path) -> None:
    StepScales(path, "").save({"chest": LONG})
    assert not path.exists()
    StepScales(path, "Ada").save({"chest": LONG})
    assert StepScales(path, "").learnt == {}


def test_the_file_has_no_names(path: Path) -> None:
    StepScales(path, "Ada Lovelace").save({"chest": LONG})
    assert b"Ada" not in path.read_bytes()


def test_a_person_is_forgotten_and_the_others_are_not(path: Path) -> None:
    for person in ("Ada", "Ben"):
        StepScales(path, person).save({"chest": LONG, "hip": SHORT})
    before = path.read_bytes()
    assert StepScales(path, "Ada").forget() == (("chest", "hip"), ())
    assert StepScales(path, "Ada").learnt == {}
    assert StepScales(path, "Ben").learnt == {"chest": LONG, "hip": SHORT}
    assert len(path.read_bytes()) < 0.6 * len(before)
    assert [one.name for one in path.parent.iterdir()] == [path.name]


def test_forgetting_whom_nothing_is_known_of_changes_nothing(path: Path) -> None:
    StepScales(path, "Ada").save({"chest": LONG})
    before = path.read_bytes()
    assert StepScales(path, "Ben").forget() == ((), ())
    assert StepScales(path, "").forget() == ((), ())
    assert path.read_bytes() == before


def test_forgetting_leaves_no_file_that_cannot_be_read(path: Path) -> None:
    unfinished, damaged = path.with_suffix(".new"), path.with_suffix(".damaged")
    path.write_bytes(b"damaged")
    unfinished.write_bytes(b"half")
    assert StepScales(path, "Ada").forget() == ((), (unfinished, damaged))
    assert list(path.parent.iterdir()) == []


@pytest.mark.parametrize(
    "content", [b"", b"\0" * 40, b'{"people": {"x": {"chest": {"factor": -1, "std": 1}}}}']
)
def test_a_damaged_file_is_set_aside_and_all_begin_anew(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    scales = StepScales(path, "Ada")
    assert scales.learnt == {}
    assert path.with_suffix(".damaged").read_bytes() == content
    scales.save({"chest": LONG})
    assert StepScales(path, "Ada").learnt == {"chest": LONG}
