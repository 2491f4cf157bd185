"""Post-processing of an incident, in a process with a memory limit of its own."""

from __future__ import annotations

import os
import resource
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Thread

import msgspec
import psutil

from base_station.process import gc_tuning
from base_station.replay.post_processing import PostProcessingResult, PostProcessor
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import PostProcessingJob
from base_station.replay.processes.wire import (
    Failure,
    PostProcessingResultFrame,
    ProgressFrame,
    UnitTrailsFrame,
)
from base_station.replay.solved_tracks import Tracks
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.smoothed import packed
from shared.clock import Clock
from shared.errors import MusterError

_NICE = 9  # beyond that of all who look at the past
_STEP = 0.01  # of progress that is reported


class StationTime:
    """The station's time, which goes on from that of the job."""

    def __init__(self, now_ns: int, clock: Clock) -> None:
        self._ahead_ns = now_ns - clock.utc_ns()
        self._clock = clock

    def utc_ns(self) -> int:
        return self._clock.utc_ns() + self._ahead_ns

    def monotonic_ns(self) -> int:
        return self._clock.monotonic_ns()


def lower_priority(line: FrameChannel) -> None:
    """Lowers its priority below live work, and ends when the socket is closed."""
    os.nice(_NICE)
    gc_tuning.return_free_memory()
    Thread(target=_end_with, args=(line,), name="look-back-line", daemon=True).start()


@contextmanager
def bounded(job: PostProcessingJob, line: FrameChannel) -> Iterator[None]:
    """Limit the memory of the job; beyond it the job fails, and reports the reason."""
    before, most = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (job.memory_mb * 1_000_000, most))
    try:
        if psutil.Process().memory_info().data > job.memory_mb * 1_000_000:
            raise MemoryError  # the limit holds for new memory only
        yield
    except MemoryError:
        resource.setrlimit(resource.RLIMIT_DATA, (before, most))
        line.send(Failure(_too_large(job), is_memory=True))
    except MusterError as error:
        line.send(Failure.of(error))


def incident_of(job: PostProcessingJob) -> IncidentRow:
    return IncidentRow(
        incident_id=job.incident_id,
        name="",
        opened_ns=job.opened_ns,
        closed_ns=job.closed_ns,
        late_data_ns=job.late_data_ns,
    )


def post_process(
    job: PostProcessingJob, post_processor: PostProcessor, live: Tracks, line: FrameChannel
) -> None:
    reported = [0.0]

    def report_progress(done: float) -> None:
        if done - reported[0] >= _STEP or done >= 1.0:
            reported[0] = done
            line.send(ProgressFrame(done))

    _send_result(post_processor.post_process(incident_of(job), live, report_progress), line)


def _send_result(made: PostProcessingResult, line: FrameChannel) -> None:
    if not made.is_kept:
        for unit_id in sorted({*made.smoothed, *made.raw}):
            line.send(
                UnitTrailsFrame(
                    unit_id, *(_packed(one, unit_id) for one in (made.smoothed, made.raw))
                )
            )
    line.send(
        PostProcessingResultFrame(made.made_ns, msgspec.msgpack.encode(made.report), made.is_kept)
    )


def _packed(tracks: Tracks, unit_id: str) -> bytes | None:
    return packed(tracks[unit_id]) if unit_id in tracks else None


def _too_large(job: PostProcessingJob) -> str:
    return (
        f"what is known afterwards of {job.incident_id} takes more memory than the "
        f"{job.memory_mb} MB that a station has for it: work it out on another machine, from a "
        f"copy of the station's folder: muster base smooth {job.incident_id} --data COPY"
    )


def _end_with(line: FrameChannel) -> None:
    while line.receive() is not None:
        pass
    os._exit(1)
