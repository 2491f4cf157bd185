"""Compilation of the trackers' kernels before an agent needs them: a minute or two once, then
cached.

On a unit each tracker is compiled in a process of its own, one after the other: what the compiler
takes of the memory for one of them is free again before the next.  The process that starts them
waits all that time, and loads neither trackers nor compiler.  Where memory is not short, one
process compiles all of them in less time, as it loads the compiler once.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from shared.errors import UserError


def compile_trackers(*, one_process: bool = False) -> None:
    """Compile every tracker, those of several sensors too.

    ``UserError`` where one of the processes is killed.
    """
    spawning = get_context("spawn")
    tasks_per_process = None if one_process else 1
    with ProcessPoolExecutor(1, spawning, max_tasks_per_child=tasks_per_process) as processes:
        for name in processes.submit(tracker_names).result():
            try:
                processes.submit(compile_tracker, name).result()
            except BrokenProcessPool:
                raise UserError(
                    f"The process that compiled the tracker '{name}' was killed: most likely "
                    "memory was short. Stop other programs or add swap, then compile again."
                ) from None


def tracker_names() -> list[str]:
    from edge.tracker.registry import MULTI_SENSOR_TRACKERS, TRACKERS  # noqa: PLC0415

    return [*(one.name for one in TRACKERS), *(one.name for one in MULTI_SENSOR_TRACKERS)]


def compile_tracker(name: str) -> None:
    """Run the tracker of this name over three seconds of stillness."""
    import numpy as np  # noqa: PLC0415

    from edge.samples import ImuBatch, SensorDescription  # noqa: PLC0415
    from edge.tracker.interface import BodyDimensions, WornSensor  # noqa: PLC0415
    from edge.tracker.registry import MULTI_SENSOR_TRACKERS, TRACKERS  # noqa: PLC0415

    rate_hz = 100.0
    still = ImuBatch(
        t_ns=np.arange(300) * 10_000_000,
        accel_mps2=np.tile([0.0, 0.0, 9.81], (300, 1)),
        gyro_radps=np.zeros((300, 3)),
    )
    for single in TRACKERS:
        if single.name == name:
            tracker = single.make(SensorDescription("still", rate_hz=rate_hz))
            tracker.push(still)
            tracker.finish()
    for several in MULTI_SENSOR_TRACKERS:
        if several.name == name:
            places = [choices[0] for choices in several.places]
            sensors = {
                place: WornSensor(SensorDescription(place, rate_hz=rate_hz), place)
                for place in places
            }
            person = several.make(sensors, BodyDimensions())
            for sensor in sensors:
                person.push(sensor, still)
            person.finish()
