"""What is asked of a unit's recording, by whom and into which folder; and what is refused."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from base_station.recordings import fetch as fetching
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import Ask, Fetch, FetchState, Wanted
from shared.clock import SystemClock
from shared.errors import DataFolderInUseError, UserError
from shared.messages.recording import RecordedFile, RecordingIndex, RecordingPiece
from tests.recorded_unit import SECONDS, RecordedUnit, U, begin, finish
from tests.waiting import until


@pytest.mark.parametrize(("from_s", "to_s"), [(-900.0, -800.0), (SECONDS + 900, SECONDS + 1900)])
def test_a_window_without_a_recording_is_said(
    unit: RecordedUnit, tmp_path: Path, from_s: float, to_s: float
) -> None:
    fetch = finish(begin(unit, tmp_path, unit.window(from_s, to_s)))
    assert fetch.state is FetchState.FAILED
    assert "no recording of that time" in fetch.problem


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "/etc/passwd", "a/../b", "..", "a/b/c", "a/.."]
)
def test_a_unit_cannot_name_a_file_outside_its_folder(tmp_path: Path, name: str) -> None:
    def ask(_: str, question: str) -> bytes | None:
        assert question.startswith("index")
        return RecordingIndex((RecordedFile(name, 10),), 1).to_bytes()

    fetch = finish(Fetch(ask, tmp_path, Wanted(U, 1, 2), SystemClock()))
    assert fetch.state is FetchState.FAILED
    assert "names files" in fetch.problem


@pytest.mark.parametrize(
    "question",
    [
        "piece?path=../journal.sqlite;offset=0;length=10",
        "piece?path=calibrations/../journal.sqlite;offset=0;length=10",
        "piece?path=/etc/passwd;offset=0;length=10",
    ],
)
def test_a_station_gets_nothing_but_the_recording(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is not None
    piece = RecordingPiece.from_bytes(answer)
    assert piece.gone
    assert piece.data == b""


@pytest.mark.parametrize(
    "question",
    ["piece?path=a", "index?from=x;to=2", "what?", "piece?path=a/b;offset=-1;length=3", "digest?"],
)
def test_questions_that_make_no_sense_are_not_answered(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is None or RecordingPiece.from_bytes(answer).gone


def test_a_disk_that_has_no_room_is_said_before_anything_is_pulled(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(5):
            fetch.step()
        assert fetch.state is FetchState.WAITING
        assert "when the disk is freed" in fetch.problem
        assert "piece" not in unit.questions
    assert finish(fetch).state is FetchState.DONE


def test_a_disk_on_which_the_log_grows_meanwhile_is_left_to_it(
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
        assert fetch.state is FetchState.WAITING
        assert unit.questions.count("piece") <= asked + 1  # which was asked before
    fetch = finish(fetch)
    assert fetch.state is FetchState.DONE
    for one in unit.boot.iterdir():
        assert (tmp_path / U / unit.boot.name / one.name).read_bytes() == one.read_bytes()


def test_a_disk_that_gets_full_on_the_way_is_said_and_what_came_is_kept(
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
    assert fetch.state is FetchState.FAILED
    assert "No space left on device" in fetch.problem
    assert finish(begin(unit, tmp_path)).state is FetchState.DONE


def test_two_pulls_from_one_unit_do_not_write_over_each_other(
    unit: RecordedUnit, tmp_path: Path
) -> None:
    fetch = begin(unit, tmp_path)
    with pytest.raises(DataFolderInUseError, match="pull"):
        begin(unit, tmp_path)
    fetch.close()


def desk(ask: Ask, folder: Path) -> RecordingDesk:
    return RecordingDesk(ask, folder, SystemClock())


def test_a_station_that_is_started_again_goes_on(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as first:
        first.add("chief", unit.window())
        until(lambda: "does not answer" in first.pulls()[0].problem)
    unit.linked = True
    with desk(unit.ask, tmp_path) as second:
        until(lambda: second.pulls()[0].state is FetchState.DONE)
        (view,) = second.views()
    assert view.unit_id == U
    assert view.done_bytes == view.total_bytes > 0
    assert second.pulls()[0].by == "chief"


def test_a_unit_that_is_away_holds_up_no_other(unit: RecordedUnit, tmp_path: Path) -> None:
    away = Wanted("FF-02", 1, 2)
    with desk(unit.ask, tmp_path) as both:
        both.add("chief", away)
        both.add("chief", unit.window(0.0, 600.0))
        until(lambda: both.pulls()[1].state is FetchState.DONE)
        assert both.pulls()[0].state is FetchState.WAITING


def test_a_pull_can_be_stopped_and_asked_for_again(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as one:
        pull = one.add("chief", unit.window())
        with pytest.raises(UserError, match="already"):
            one.add("chief", unit.window())
        assert one.stop(pull.fetch_id)
        assert not one.stop(pull.fetch_id)
        unit.linked = True
        one.add("chief", unit.window())
        until(lambda: one.pulls()[-1].state is FetchState.DONE)
    assert one.pulls()[0].problem == "stopped by a person"


def test_a_window_that_ends_before_it_begins_is_refused(unit: RecordedUnit, tmp_path: Path) -> None:
    with desk(unit.ask, tmp_path) as one, pytest.raises(UserError, match="before it begins"):
        one.add("chief", Wanted(U, 2, 1))
