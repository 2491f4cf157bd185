"""Tests of the worker thread."""

from __future__ import annotations

import logging
from queue import SimpleQueue
from threading import Event, current_thread

import pytest

from shared.errors import StoreError
from shared.worker import UNTIL_WOKEN, Worker

_PATIENCE_S = 10.0


def test_step_is_repeated_after_the_pause_that_it_returns() -> None:
    steps = SimpleQueue[str]()

    def step() -> float:
        steps.put(current_thread().name)
        return 0.0

    worker = Worker("tested", step, "it fails")
    worker.start()
    assert [steps.get(timeout=_PATIENCE_S) for _ in range(3)] == ["tested"] * 3
    assert worker.close(_PATIENCE_S)


def test_worker_that_waits_until_woken_takes_one_step_for_each_wake() -> None:
    steps = SimpleQueue[int]()

    def step() -> float:
        steps.put(1)
        return UNTIL_WOKEN

    worker = Worker("tested", step, "it fails")
    worker.start()
    for _ in range(3):
        steps.get(timeout=_PATIENCE_S)
        worker.wake()
    steps.get(timeout=_PATIENCE_S)
    assert worker.close(_PATIENCE_S)
    assert steps.empty()


def test_wake_during_a_step_makes_the_next_step_due() -> None:
    begun, go_on, steps = SimpleQueue[int](), Event(), list[int]()

    def step() -> float:
        steps.append(1)
        begun.put(1)
        go_on.wait(_PATIENCE_S)
        return UNTIL_WOKEN

    worker = Worker("tested", step, "it fails")
    worker.start()
    begun.get(timeout=_PATIENCE_S)
    worker.wake()
    go_on.set()
    begun.get(timeout=_PATIENCE_S)
    assert worker.close(_PATIENCE_S)
    assert len(steps) == 2


@pytest.mark.parametrize("error", [StoreError("full"), KeyError("unit")])
def test_failed_step_is_repeated_and_logged_once(
    error: Exception, caplog: pytest.LogCaptureFixture
) -> None:
    failures, succeeded = [error, error], Event()

    def step() -> float:
        if failures:
            raise failures.pop()
        succeeded.set()
        return UNTIL_WOKEN

    worker = Worker("tested", step, "the disk is not read", retry_s=0.0)
    with caplog.at_level(logging.WARNING):
        worker.start()
        assert succeeded.wait(_PATIENCE_S)
        assert worker.is_working
        assert worker.close(_PATIENCE_S)
    assert [one.getMessage().partition(":")[0] for one in caplog.records] == [
        "the disk is not read",
        "over",
    ]
    assert worker.fault == ""


def test_worker_all_steps_of_which_fail_is_reported_as_not_working() -> None:
    failed = SimpleQueue[int]()

    def step() -> float:
        failed.put(1)
        raise StoreError("full")

    worker = Worker("tested", step, "the disk is not read", retry_s=0.0)
    worker.start()
    for _ in range(40):
        failed.get(timeout=_PATIENCE_S)
    assert worker.is_alive
    assert not worker.is_working
    assert worker.fault == "full"
    assert worker.close(_PATIENCE_S)


def test_worker_that_hangs_is_left_behind_at_the_deadline() -> None:
    begun, answer = Event(), Event()

    def step() -> float:
        begun.set()
        answer.wait(_PATIENCE_S)
        return UNTIL_WOKEN

    worker = Worker("tested", step, "it fails")
    worker.start()
    assert begun.wait(_PATIENCE_S)
    assert not worker.close(0.0)
    answer.set()
    assert worker.join(_PATIENCE_S)


def test_last_task_is_done_in_the_thread_after_the_last_step() -> None:
    done: list[str] = []

    def step() -> float:
        done.append("step")
        worker.stop()
        return 0.0

    worker = Worker("tested", step, "it fails", at_end=lambda: done.append(current_thread().name))
    worker.start()
    assert worker.join(_PATIENCE_S)
    assert done == ["step", "tested"]
    assert not worker.is_working


def test_worker_that_never_started_closes_at_once() -> None:
    assert Worker("tested", lambda: UNTIL_WOKEN, "it fails").close()


def test_step_that_waits_is_reported_of_the_end() -> None:
    waiting, stopped = Event(), list[bool]()

    def step() -> float:
        waiting.set()
        while not worker.wait(_PATIENCE_S):
            pass
        stopped.append(True)
        return UNTIL_WOKEN

    worker = Worker("tested", step, "it fails")
    worker.start()
    assert waiting.wait(_PATIENCE_S)
    worker.wake()
    assert worker.close(_PATIENCE_S)
    assert stopped == [True]


def test_periodic_task_is_called_with_the_event_that_ends_it() -> None:
    called = SimpleQueue[Event]()
    worker = Worker.periodic("tested", 0.001, called.put, "it fails")
    worker.start()
    stopping = called.get(timeout=_PATIENCE_S)
    assert not stopping.is_set()
    assert worker.close(_PATIENCE_S)
    assert stopping.is_set()
