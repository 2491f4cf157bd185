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
