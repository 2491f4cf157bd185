"""Scales of the wearer's steps are kept at the end of the agent, for the next walk."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from edge.agent.step_learning import WALK_STD
from edge.agent.step_scale_keeper import StepScaleKeeper
from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "step_scales.json"


def keeper(path: Path, person: str = "Ada") -> StepScaleKeeper:
    return StepScaleKeeper(StepScales(path, person))


def test_the_next_walk_starts_with_what_was_learnt(path: Path) -> None:
    with closing(keeper(path)) as first:
        assert first.start_scales == {}
        first.take({"chest": StepScale(1.05, 0.05)})
        first.take({"chest": StepScale(1.15, 0.02)})
        assert first.start_scales == {}, "this walk is the station's to learn from"
    with closing(keeper(path)) as second:
        start = second.start_scales["chest"]
    assert 1.09 < start.factor < 1.15
    assert WALK_STD < start.std < 0.06


def test_one_walk_counts_once_however_often_it_is_taken(path: Path) -> None:
    with closing(keeper(path)) as often:
        for _ in range(50):
            often.take({"chest": StepScale(1.15, 0.02)})
    with closing(keeper(path.with_name("other.json"))) as once:
        once.take({"chest": StepScale(1.15, 0.02)})
    assert StepScales(path, "Ada").learnt == StepScales(path.with_name("other.json"), "Ada").learnt


def test_another_wearer_starts_at_the_mean_of_people(path: Path) -> None:
    with closing(keeper(path)) as first:
        first.take({"chest": StepScale(1.15, 0.02)})
    with closing(keeper(path, "Ben")) as second:
        assert second.start_scales == {}


def test_a_scale_of_no_walk_is_not_kept(path: Path) -> None:
    with closing(keeper(path)) as one:
        one.take({"chest": StepScale(7.0, 0.02)})
    assert StepScales(path, "Ada").learnt == {}
