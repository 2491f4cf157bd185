"""A pull of a recording where the station's disk has no room."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from base_station.unit_sync.recordings import transfer as fetching
from base_station.unit_sync.recordings.transfer import TransferState
from tests.rig.changing_recordings import RecordingsUnit
from tests.rig.recorded_unit import RecordedUnit, U, begin, finish


def test_lack_of_disk_space_is_reported_before_the_transfer(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(5):
            fetch.step()
        assert fetch.state is TransferState.WAITING
        assert "when the disk is freed" in fetch.problem
        assert "piece" not in unit.questions
    assert finish(fetch).state is TransferState.DONE


def test_transfer_pauses_when_the_log_needs_the_disk(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()
    asked = unit.questions.count("piece")
    assert 0 < fetch.done_bytes < fetch.total_bytes
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(5):
            fetch.step()
        assert fetch.state is TransferState.WAITING
        assert unit.questions.count("piece") <= asked + 1  # which was asked before
    fetch = finish(fetch)
    assert fetch.state is TransferState.DONE
    for one in unit.boot.iterdir():
        assert (tmp_path / U / unit.boot.name / one.name).read_bytes() == one.read_bytes()


def test_disk_filled_during_the_transfer_is_reported_and_keeps_the_received_part(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", full)
        finish(fetch)
    assert fetch.state is TransferState.FAILED
    assert "No space left on device" in fetch.problem
    assert finish(begin(unit, tmp_path)).state is TransferState.DONE


def test_recordings_of_other_times_count_as_no_free_space(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit = RecordingsUnit(old=b"old" * 1000)
    finish(unit.pull(tmp_path))
    unit.files = {f"boot/{name}.mcap": bytes(400) for name in "ab"}
    unit.pieces.clear()
    free_bytes = fetching._SPARED_BYTES + 500
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=free_bytes))
    fetch = unit.pull(tmp_path)
    for _ in range(5):
        fetch.step()
    fetch.close()
    assert fetch.state is TransferState.WAITING
    assert unit.pieces == []
