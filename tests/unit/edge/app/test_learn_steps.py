"""A walk of known length shows how long a person's steps are; one that is impossible is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from threading import Event

import pytest

from edge.app.learn_steps import learn_steps, with_person
from edge.config import EdgeConfig, WearerConfig
from edge.storage.data_folder import UnitDataFolder
from edge.storage.step_scales import StepScales
from shared.errors import MusterError

TRUE_M = 50.0  # of the walk "straight"


@pytest.fixture
def config(tmp_path: Path) -> EdgeConfig:
    return EdgeConfig(
        "simulated:straight?seed=3&worn_on=chest",
        worn_on="chest",
        unit="u1",
        data=tmp_path,
        wearer=WearerConfig(person="Ada"),
    )


def kept(config: EdgeConfig, person: str = "Ada") -> dict[str, float]:
    learnt = StepScales(config.data / "u1" / "step_scales.json", person).learnt
    return {place: one.factor for place, one in learnt.items()}


@pytest.mark.slow
def test_a_walk_of_known_length_is_kept_for_its_person(
    config: EdgeConfig, capsys: pytest.CaptureFixture[str]
) -> None:
    learn_steps(config, TRUE_M, None, Event())
    printed = capsys.readouterr().out
    assert "50 m walked" in printed
    assert "sensor at chest" in printed
    assert 1.04 < kept(config)["chest"] < 1.15, "the steps of the simulated wearer are longer"
    assert kept(config, "Ben") == {}


@pytest.mark.slow
@pytest.mark.parametrize("length_m", [500.0, 10.0])
def test_a_length_that_cannot_be_is_refused_with_what_was_tracked(
    config: EdgeConfig, length_m: float
) -> None:
    with pytest.raises(MusterError, match=r"m were tracked in \d+ strides, and .* are given"):
        learn_steps(config, length_m, None, Event())
    assert kept(config) == {}


@pytest.mark.parametrize("length_m", [0.0, -20.0, 9.9, 1e6, math.nan])
def test_lengths_that_measure_nothing_are_refused(config: EdgeConfig, length_m: float) -> None:
    with pytest.raises(MusterError, match="between 10 and 1000 m"):
        learn_steps(config, length_m, None, Event())


def test_a_walk_without_a_person_is_refused(config: EdgeConfig) -> None:
    with pytest.raises(MusterError, match="give --person"):
        learn_steps(replace(config, wearer=WearerConfig()), TRUE_M, None, Event())


@pytest.mark.slow
def test_a_sensor_on_a_foot_has_no_steps_to_learn(config: EdgeConfig) -> None:
    with pytest.raises(MusterError, match="does not take its path from steps alone"):
        learn_steps(replace(config, worn_on="foot"), TRUE_M, 2.0, Event())


def test_a_unit_that_runs_is_not_disturbed(config: EdgeConfig) -> None:
    folder = UnitDataFolder(config.data / "u1")
    try:
        with pytest.raises(MusterError, match="agent"):
            learn_steps(config, TRUE_M, None, Event())
    finally:
        folder.close()


def test_a_person_on_the_command_line_overrules_the_settings(config: EdgeConfig) -> None:
    assert with_person(config, "Ben").wearer.person == "Ben"
    assert with_person(config, None).wearer.person == "Ada"
