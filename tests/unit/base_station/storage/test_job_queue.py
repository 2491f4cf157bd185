"""Jobs of operators: their state is reported at once, whatever the disk does."""

from __future__ import annotations

from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import NamedTuple

import msgspec
import pytest

from base_station.storage.job_queue import JobList, JobQueue
from shared.errors import StoreError
from shared.worker import UNTIL_WOKEN
from tests.rig.waiting import PATIENCE_S, until


class State(NamedTuple):
    is_over: bool = False


class Job(msgspec.Struct):
    name: str
    state: State = State()
    share: float = 0.0


def asked_for(jobs: JobList[Job], name: str) -> Job:
    return jobs.add(lambda _: Job(name))


def test_state_is_reported_while_the_disk_hangs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The live picture shows it."""
    jobs = JobList(tmp_path / "jobs.json", Job)
    asked_for(jobs, "first")
    (first,) = jobs.under_way()
    asked, answers = Event(), Event()

    def hang(*_: object) -> None:
        asked.set()
        answers.wait()

    reported: list[tuple[Job, ...]] = []
    with monkeypatch.context() as patched:
        patched.setattr("base_station.storage.job_queue.write_atomically", hang)
        saving = Thread(target=asked_for, args=(jobs, "second"))
        saving.start()
        assert asked.wait(PATIENCE_S)
        looking = Thread(target=lambda: reported.append(jobs.all()), daemon=True)
        looking.start()
        noting = Thread(target=lambda: jobs.note(first, save=False, share=0.5), daemon=True)
        noting.start()
        try:
            until(lambda: reported and first.share, patience_s=10.0)
            assert [one.name for one in reported[0]] == ["first"], "the second is not on the disk"
        finally:
            answers.set()
        saving.join()
    assert [one.name for one in jobs.all()] == ["first", "second"]
    assert jobs.note(first, save=True, share=1.0)
    again = JobList(tmp_path / "jobs.json", Job)
    assert [(one.name, one.share) for one in again.all()] == [("first", 1.0), ("second", 0.0)]
    again.note_each(lambda one: one.name == "first", share=0.0)
    reported_later = JobList(tmp_path / "jobs.json", Job).all()
    assert [one.share for one in reported_later] == [0.0, 0.0]


def test_last_finished_jobs_and_all_open_ones_are_reported(tmp_path: Path) -> None:
    jobs = JobList(tmp_path / "jobs.json", Job)
    for number in range(50):
        asked_for(jobs, f"job {number}")
        *_, last = jobs.under_way()
        if number != 3:
            jobs.note(last, save=False, state=State(is_over=True))
    over = [f"job {number}" for number in range(30, 50)]
    assert [one.name for one in jobs.all()] == [*over[:-1], "job 3", over[-1]]


def test_job_that_the_disk_refuses_is_not_begun(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    jobs = JobList(tmp_path / "jobs.json", Job)

    def refuse(*_: object) -> None:
        raise StoreError("the disk is full")

    monkeypatch.setattr("base_station.storage.job_queue.write_atomically", refuse)
    with pytest.raises(StoreError, match="nothing is done: the disk is full"):
        asked_for(jobs, "first")
    assert jobs.all() == ()


def test_queue_works_on_jobs_of_an_earlier_run_and_on_added_ones(tmp_path: Path) -> None:
    path, done = tmp_path / "jobs.json", SimpleQueue[str]()
    asked_for(JobList(path, Job), "before the restart")

    def work(jobs: list[Job]) -> float:
        for job in jobs:
            queue.note(job, save=True, state=State(is_over=True))
            done.put(job.name)
        return UNTIL_WOKEN

    queue = JobQueue(path, Job, "tested", work, "jobs are not done")
    queue.start()
    assert done.get(timeout=PATIENCE_S) == "before the restart"
    asked_for(queue, "added")
    assert done.get(timeout=PATIENCE_S) == "added"
    queue.close()
    assert queue.is_closing
    assert JobList(path, Job).under_way() == []
