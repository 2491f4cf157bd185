"""The mayday on disk: the last state is there after any end, and a bad disk blocks nothing."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from edge.agent import mayday_latch
from edge.agent.mayday_latch import MaydayLatch
from shared import durable_names
from shared.clock import ManualClock
from tests.rig.waiting import until


@pytest.fixture
def latched(tmp_path: Path):
    latches: list[MaydayLatch] = []

    def latched() -> MaydayLatch:
        latches.append(MaydayLatch(tmp_path / "mayday", ManualClock()))
        return latches[-1]

    yield latched
    for latch in latches:
        latch.close()


def test_last_state_is_known_after_a_restart(latched, tmp_path: Path) -> None:
    for is_active in (False, True, True, False, False):
        latch = latched()
        latch.set(is_active=is_active)
        latch.close()
        assert latch.fault == ""
        assert latched().was_active is is_active
    assert list(tmp_path.iterdir()) == []


def test_state_is_written_while_the_agent_runs(latched, tmp_path: Path) -> None:
    """A power cut comes without a goodbye."""
    latch = latched()
    latch.set(is_active=True)
    until((tmp_path / "mayday").exists, "the mayday is written")
    assert (tmp_path / "mayday").read_text() == "mayday active since 2023-11-14T22:13:20Z\n"
    latch.set(is_active=False)
    until(lambda: not (tmp_path / "mayday").exists(), "it is taken back")


def test_power_cut_between_any_two_steps_leaves_before_or_after(
    latched, tmp_path: Path, monkeypatch
) -> None:
    """Every rename is of a file that is on the disk, and is flushed itself."""
    steps: list[str] = []

    def noting(name: str, call: Callable[..., object]) -> Callable[..., object]:
        def noted(*arguments: object, **options: object) -> object:
            there = sorted(path.name for path in tmp_path.iterdir())
            steps.append(f"{name} {there}")
            return call(*arguments, **options)

        return noted

    monkeypatch.setattr(os, "fsync", noting("fsync", os.fsync))
    monkeypatch.setattr(Path, "replace", noting("replace", Path.replace))
    monkeypatch.setattr(Path, "unlink", noting("unlink", Path.unlink))
    latch = latched()
    latch.set(is_active=True)
    until(lambda: latch._is_on_disk, "it is written")
    latch.set(is_active=False)
    until(lambda: not latch._is_on_disk, "it is taken back")
    assert steps == [
        "unlink []",  # rests of an earlier attempt
        "fsync ['mayday.new']",  # the text
        "replace ['mayday.new']",
        "fsync ['mayday']",  # the folder
        "unlink ['mayday']",
        "fsync []",
    ]


@pytest.mark.parametrize("left", ["", "\0" * 40])
def test_rest_of_an_interrupted_write_is_ignored(latched, tmp_path, left) -> None:
    (tmp_path / "mayday.new").write_text(left)
    latch = latched()
    assert not latch.was_active
    latch.set(is_active=True)
    latch.close()
    assert latched().was_active


def test_refusing_disk_is_reported_and_retried(latched, tmp_path, monkeypatch) -> None:
    def refuse(_: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(mayday_latch, "sync_folder", refuse)
    latch = latched()
    latch.set(is_active=True)
    until(lambda: "No space left" in latch.fault, "the fault")
    assert "would not survive a restart" in latch.fault
    monkeypatch.setattr(mayday_latch, "sync_folder", durable_names.sync_folder)
    until(lambda: latch.fault == "", "it is written after all")
    assert latched().was_active


def test_unreadable_disk_prevents_no_start(latched, monkeypatch) -> None:
    def refuse(_: Path) -> None:
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(Path, "lstat", refuse)
    latch = latched()
    assert not latch.was_active
    assert "whether a mayday was active cannot be read" in latch.fault
