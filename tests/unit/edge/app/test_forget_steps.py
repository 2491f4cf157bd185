"""Command that deletes what a unit has learnt of a person's steps."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from edge.cli import app
from edge.storage.data_folder import UnitDataFolder
from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale

LEARNT = StepScale(1.08, 0.04)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Data folder of a unit that two people have worn."""
    unit = UnitDataFolder(tmp_path / "FF-01")
    for person in ("Ada", "Ben"):
        StepScales(unit.step_scales, person).save({"chest": LEARNT})
    unit.close()
    return unit.path


def forget(folder: Path, person: str) -> Result:
    return CliRunner().invoke(app, ["forget-steps", str(folder), "--person", person])


def learnt(folder: Path, person: str) -> bool:
    return bool(StepScales(folder / "step_scales.json", person).learnt)


def test_a_person_is_forgotten_once(folder: Path) -> None:
    done = forget(folder, "Ada")
    assert (done.exit_code, done.stdout) == (
        0,
        "Steps of this person, sensor at chest: forgotten.\n",
    )
    assert not learnt(folder, "Ada")
    assert learnt(folder, "Ben")
    again = forget(folder, "Ada")
    assert again.exit_code != 0
    assert "nothing on the steps of 'Ada'" in str(again.exception)


@pytest.mark.parametrize("person", ["Eve", "ada", ""])
def test_a_person_who_is_not_there_is_refused(folder: Path, person: str) -> None:
    refused = forget(folder, person)
    assert refused.exit_code != 0
    assert "as wearer.person" in str(refused.exception)
    assert learnt(folder, "Ada")


def test_a_folder_that_is_no_units_is_refused_and_not_made(tmp_path: Path) -> None:
    for wrong in (tmp_path / "none", tmp_path):
        refused = forget(wrong, "Ada")
        assert refused.exit_code != 0
        assert "has no step_scales.json" in str(refused.exception)
    assert list(tmp_path.iterdir()) == []


def test_a_unit_that_runs_would_keep_it_and_is_refused(folder: Path) -> None:
    running = UnitDataFolder(folder)
    try:
        refused = forget(folder, "Ada")
    finally:
        running.close()
    assert refused.exit_code != 0
    assert "another agent is using" in str(refused.exception)
    assert learnt(folder, "Ada")


def test_a_damaged_file_is_deleted_whole_and_named(folder: Path) -> None:
    (folder / "step_scales.json").write_bytes(b"\0" * 40)
    done = forget(folder, "Ada")
    assert done.exit_code == 0
    assert "step_scales.damaged could not be read" in done.stdout
    assert not list(folder.glob("step_scales*"))
