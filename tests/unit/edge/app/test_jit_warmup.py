"""Compilation of the trackers in advance."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Self

import pytest
from numba.core.dispatcher import Dispatcher

from edge.app import jit_warmup
from edge.app.jit_warmup import compile_tracker, compile_trackers
from edge.samples import SensorDescription
from edge.simulation.factory import open_simulation
from edge.tracker.interface import WornSensor
from edge.tracker.registry import (
    MULTI_SENSOR_TRACKERS,
    TRACKERS,
    make_multi_sensor_tracker,
    make_tracker,
)
from shared.errors import UserError

NAMES = [*(one.name for one in TRACKERS), *(one.name for one in MULTI_SENSOR_TRACKERS)]
WALK = "square-60m?seed=0"
RATE_HZ = 200.0
WALKED_S = 10.0


class RecordingExecutor:
    """Takes the place of the processes, and compiles nothing; ``killed``: the tracker whose process
    is killed.
    """

    def __init__(self, killed: str = "") -> None:
        self.names: list[str] = []
        self._killed = killed

    def __call__(self, *_: object, **__: object) -> Self:
        return self

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def submit(self, task: Callable[..., Any], *arguments: str) -> Future[Any]:
        done: Future[Any] = Future()
        if task is not compile_tracker:
            done.set_result(task(*arguments))
            return done
        self.names += arguments
        if self._killed in arguments:
            done.set_exception(BrokenProcessPool())
        else:
            done.set_result(None)
        return done


def compiled_signatures() -> dict[str, list[Any]]:
    """Return those of each kernel of the trackers, by its name."""
    return {
        f"{name}.{member}": list(kernel.signatures)
        for name, module in sorted(sys.modules.items())
        if name.startswith("edge.tracker.")
        for member, kernel in vars(module).items()
        if isinstance(kernel, Dispatcher)
    }


def walk(name: str) -> None:
    """Track a walk, all sensors of the person with the same samples."""
    imu = next(open_simulation(WALK).batches(WALKED_S)).imu
    for several in MULTI_SENSOR_TRACKERS:
        if several.name == name:
            places = [choices[0] for choices in several.places]
            sensors = {
                place: WornSensor(SensorDescription(place, rate_hz=RATE_HZ), place)
                for place in places
            }
            person = make_multi_sensor_tracker(name, sensors)
            for sensor in sensors:
                person.push(sensor, imu)
            person.finish()
            return
    tracker = make_tracker(name, SensorDescription("walked", rate_hz=RATE_HZ))
    tracker.push(imu)
    tracker.finish()


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_walk_needs_no_kernel_that_stillness_has_not_compiled(name: str) -> None:
    compile_tracker(name)
    before = compiled_signatures()
    walk(name)
    assert compiled_signatures() == before
    assert any(before.values())


def test_every_tracker_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    executor = RecordingExecutor()
    monkeypatch.setattr(jit_warmup, "ProcessPoolExecutor", executor)
    compile_trackers()
    assert executor.names == NAMES


@pytest.mark.slow
def test_a_tracker_is_compiled_in_a_process_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    in_process = ProcessPoolExecutor.submit

    def submit(self: ProcessPoolExecutor, task: Any, *arguments: str) -> Future[Any]:
        """One tracker alone."""
        if task is not compile_tracker:
            one: Future[Any] = Future()
            one.set_result(["hip-corridors"])
            return one
        done.extend(arguments)
        return in_process(self, task, *arguments)

    monkeypatch.setattr(ProcessPoolExecutor, "submit", submit)
    before = compiled_signatures()
    compile_trackers()
    assert done == ["hip-corridors"]
    assert compiled_signatures() == before


@pytest.mark.parametrize(("one_process", "tasks"), [(False, 1), (True, None)])
def test_memory_is_free_again_after_each_tracker_unless_one_process_does_all(
    monkeypatch: pytest.MonkeyPatch, *, one_process: bool, tasks: int | None
) -> None:
    asked: list[object] = []

    def make(*_: object, max_tasks_per_child: int | None) -> RecordingExecutor:
        asked.append(max_tasks_per_child)
        return RecordingExecutor()

    monkeypatch.setattr(jit_warmup, "ProcessPoolExecutor", make)
    compile_trackers(one_process=one_process)
    assert asked == [tasks]


def test_a_killed_process_is_reported_with_its_tracker(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jit_warmup, "ProcessPoolExecutor", RecordingExecutor(killed="two_feet"))
    with pytest.raises(UserError, match=r"'two_feet' was killed.*add swap"):
        compile_trackers()
