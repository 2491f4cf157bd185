"""Refusals of a recording's pull: other files, invalid requests, a second pull at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.unit_sync.recordings.transfer import Transfer, TransferRequest, TransferState
from shared.clock import SystemClock
from shared.errors import DataFolderInUseError
from shared.messages.recording import (
    RecordedFile,
    RecordingIndex,
    RecordingPiece,
)
from tests.rig.recorded_unit import SECONDS, RecordedUnit, U, begin, finish


@pytest.mark.parametrize(("from_s", "to_s"), [(-900.0, -800.0), (SECONDS + 900, SECONDS + 1900)])
def test_window_without_a_recording_fails_with_a_reason(
    unit: RecordedUnit, tmp_path: Path, from_s: float, to_s: float
) -> None:
    fetch = finish(begin(unit, tmp_path, unit.window(from_s, to_s)))
    assert fetch.state is TransferState.FAILED
    assert "no recording of that time" in fetch.problem


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "/etc/passwd", "a/../b", "..", "a/b/c", "a/.."]
)
def test_a_unit_cannot_name_a_file_outside_its_folder(tmp_path: Path, name: str) -> None:
    def ask(_: str, question: str) -> bytes | None:
        assert question.startswith("index")
        return RecordingIndex((RecordedFile(name, 10),), 1).to_bytes()

    fetch = finish(Transfer(ask, tmp_path, TransferRequest(U, 1, 2), SystemClock()))
    assert fetch.state is TransferState.FAILED
    assert "names files" in fetch.problem


@pytest.mark.parametrize(
    "question",
    [
        "piece?path=../journal.sqlite;offset=0;length=10",
        "piece?path=calibrations/../journal.sqlite;offset=0;length=10",
        "piece?path=/etc/passwd;offset=0;length=10",
    ],
)
def test_unit_serves_nothing_but_its_recording(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is not None
    piece = RecordingPiece.from_bytes(answer)
    assert piece.gone
    assert piece.data == b""


@pytest.mark.parametrize(
    "question",
    ["piece?path=a", "index?from=x;to=2", "what?", "piece?path=a/b;offset=-1;length=3", "digest?"],
)
def test_invalid_queries_are_not_answered(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is None or RecordingPiece.from_bytes(answer).gone


def test_second_transfer_from_a_unit_is_refused(unit: RecordedUnit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    with pytest.raises(DataFolderInUseError, match="pull"):
        begin(unit, tmp_path)
    fetch.close()
