"""Queue of erasures: done one after the other, and continued after a restart."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Event
from typing import cast

import pytest

from base_station.privacy.erasure_progress import ErasureProgress, ErasureResult, Progress
from base_station.privacy.erasure_queue import (
    ErasureJob,
    ErasureQueue,
    ErasureState,
    request_again,
)
from base_station.privacy.erasure_service import ErasureService
from shared.coded_text import TextCode, coded
from shared.errors import StoreError, UserError
from tests.rig.waiting import until


class StubEraser:
    """An ``ErasureService`` that waits in the middle, and fails on request."""

    def __init__(self) -> None:
        self.go = Event()
        self.half = Event()
        self.fails: list[BaseException] = []
        self.began: list[str] = []
        self.again: list[bool] = []
        self.done: list[str] = []
        self.from_peer: list[bool] = []
        self.damaged: list[str] = []
        self.kept: list[str] = []

    def erase_person(
        self,
        by: str,
        person_id: str,
        on_progress: Progress,
        progress: ErasureProgress,
        *,
        from_peer: bool,
    ) -> ErasureResult:
        self.from_peer.append(from_peer)
        self.began.append(person_id)
        self.again.append(progress.again)
        on_progress(0.1)
        progress.records, progress.files = progress.records + 7, progress.files + 2
        for part in self.damaged:
            progress.note_damage(part, written_anew=False)
        progress.kept = tuple(self.kept)
        if self.fails:
            raise self.fails.pop(0)
        on_progress(0.5)
        self.half.set()
        self.go.wait()
        on_progress(1.0)
        self.done.append(person_id)
        return ErasureResult(f"person {person_id} by {by}", progress.records, progress.files)


def desk(
    worker: StubEraser,
    folder: Path,
    obstacle: Callable[[ErasureJob], str] = lambda _: "",
    on_done: Callable[[ErasureJob], None] = lambda _: None,
) -> ErasureQueue:
    return ErasureQueue(cast("ErasureService", worker), folder / "kept.json", obstacle, on_done)


def test_erasure_reports_its_progress_and_result(tmp_path: Path) -> None:
    worker, reported = StubEraser(), list[ErasureJob]()
    with desk(worker, tmp_path, on_done=reported.append) as one:
        one.add("ada", "person", "p-1")
        worker.half.wait()
        (under_way,) = one.all()
        assert (under_way.state, under_way.share) == (ErasureState.WORKING, 0.5)
        assert "50%" in one.problems()[0]
        worker.go.set()
        until(lambda: one.all()[0].state is ErasureState.DONE)
        (done,) = one.all()
        assert (done.records, done.files, one.problems()) == (7, 2, ())
    assert [one.subject_id for one in reported] == ["p-1"]


def test_same_request_is_one_and_others_wait_their_turn(tmp_path: Path) -> None:
    worker = StubEraser()
    with desk(worker, tmp_path) as one:
        first = one.add("ada", "person", "p-1")
        assert one.add("bo", "person", "p-1").forgetting_id == first.forgetting_id
        one.add("ada", "person", "p-2")
        worker.half.wait()
        assert worker.began == ["p-1"]
        worker.go.set()
        until(lambda: worker.done == ["p-1", "p-2"])


def test_station_stopped_in_the_middle_continues_when_it_is_back(tmp_path: Path) -> None:
    worker = StubEraser()
    with desk(worker, tmp_path) as one:
        one.add("ada", "person", "p-1")
        worker.half.wait()
        one._jobs._worker.stop()
        worker.go.set()
    assert worker.done == []
    with desk(worker, tmp_path) as again:
        until(lambda: again.all()[0].state is ErasureState.DONE)
    assert worker.done == ["p-1"]


@pytest.mark.parametrize("kill", [False, True])
def test_erasures_of_all_attempts_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kill: bool
) -> None:
    monkeypatch.setattr("base_station.privacy.erasure_queue._AGAIN_S", 0.01)
    worker = StubEraser()
    worker.fails = [SystemExit() if kill else StoreError("the disk is full")]
    worker.go.set()
    if kill:
        one = desk(worker, tmp_path)
        one.add("ada", "person", "p-1")
        with pytest.raises(SystemExit):
            one._work_on_first(one._jobs.under_way())
        worker.fails = [StoreError("the disk is full")]
    with desk(worker, tmp_path) as one:
        one.add("ada", "person", "p-1")
        until(lambda: one.all()[0].state is ErasureState.DONE)
        (done,) = one.all()
    # The count of an attempt that was killed before it was saved is unknown.
    assert (done.records, done.files) == (14, 4)
    assert worker.again == [False, True, True][: len(worker.began)]
    assert len(worker.began) == (3 if kill else 2)


def test_impossible_request_fails_with_its_reason(tmp_path: Path) -> None:
    worker = StubEraser()
    worker.fails = [UserError("nobody knows that person")]
    with desk(worker, tmp_path) as one:
        one.add("ada", "person", "p-1")
        until(lambda: one.all()[0].state is ErasureState.FAILED)
        assert one.all()[0].problem == "nobody knows that person"


def test_failing_store_is_retried_and_reported_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("base_station.privacy.erasure_queue._AGAIN_S", 0.01)
    worker = StubEraser()
    worker.fails = [StoreError("the disk is full") for _ in range(3)]
    worker.go.set()
    with desk(worker, tmp_path) as one:
        one.add("ada", "person", "p-1")
        until(lambda: one.all()[0].state is ErasureState.DONE)
    assert worker.began == ["p-1"] * 4
    assert caplog.text.count("the disk is full") == 1


def test_standby_leaves_requests_and_reports_it(tmp_path: Path) -> None:
    worker = StubEraser()
    worker.go.set()

    def obstacle(job: ErasureJob) -> str:
        return "" if job.from_peer else "this is the standby"

    with desk(worker, tmp_path, obstacle) as one:
        one.add("ada", "person", "p-1")
        until(lambda: "standby" in one.all()[0].problem)
        assert worker.began == []
    with desk(worker, tmp_path, obstacle) as one:  # erasures of the other station are done here too
        one.add("the other station", "person", "p-2", from_peer=True)
        until(lambda: worker.done == ["p-2"])


def test_subject_erased_at_the_other_station_may_be_unknown_here(tmp_path: Path) -> None:
    worker = StubEraser()
    worker.fails = [UserError("nobody knows that person")]
    with desk(worker, tmp_path) as one:
        one.add("the other station", "person", "p-1", from_peer=True)
        until(lambda: one.all()[0].state is ErasureState.DONE)


def test_request_that_cannot_be_saved_is_refused(tmp_path: Path) -> None:
    one = desk(StubEraser(), tmp_path / "missing")
    with pytest.raises(StoreError, match="nothing is done"):
        one.add("ada", "person", "p-1")
    assert one.all() == ()


def test_request_that_waits_at_a_standby_is_done_as_the_other_station_has_done_it(
    tmp_path: Path,
) -> None:
    worker = StubEraser()
    worker.go.set()
    with desk(worker, tmp_path, lambda job: "" if job.from_peer else "does not lead") as one:
        one.add("ada", "person", "p-1")
        until(lambda: one.all()[0].problem != "")
        assert [job.subject_id for job in one.own_waiting()] == ["p-1"], "the leader fetches it"
        one.add("the other station", "person", "p-1", from_peer=True)
        until(lambda: worker.done == ["p-1"])
        assert [(job.by, job.from_peer) for job in one.all()] == [("ada", True)]
        assert one.own_waiting() == ()
    assert worker.from_peer == [True]


def test_erasure_whose_order_was_cut_off_is_requested_again(tmp_path: Path) -> None:
    for _ in range(2):
        request_again(tmp_path / "kept.json", "person", "p-1")
    (waiting,) = desk(StubEraser(), tmp_path).own_waiting()
    assert (waiting.kind, waiting.subject_id) == ("person", "p-1")


def test_what_is_damaged_and_what_stays_has_the_codes_of_all_attempts(tmp_path: Path) -> None:
    worker = StubEraser()
    worker.damaged, worker.fails = ["segment 3"], [StoreError("the disk is full")]
    worker.kept = [coded("radio-stays", "The radio stays")]
    with desk(worker, tmp_path) as one:
        one.add("ada", "person", "p-1")
        until(lambda: one.all()[0].problem != "")
    worker.damaged = []  # the second attempt does not meet it again
    worker.go.set()
    with desk(worker, tmp_path) as again:
        until(lambda: again.all()[0].state is ErasureState.DONE)
        (done,) = again.all()
    damage = "Damaged: segment 3; it stays, with all people in it"
    assert done.problem == f"{damage}. The radio stays"
    assert done.problem_code == TextCode(
        "erasure-left",
        {
            "before": damage,
            "before:": "erasure-damage-stays",
            "before:part": "segment 3",
            "last": "The radio stays",
            "last:": "radio-stays",
        },
    )
