"""Reads a source in a thread of its own, so that a sensor that hangs silences nothing else."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import dataclass
from queue import Empty, Full, Queue
from threading import Event, Thread

from edge.samples import SensorBatch
from edge.sources.port import Source
from edge.timeline import Pacer, Timeline
from shared.clock import NS_PER_S, Clock
from shared.errors import MusterError

logger = logging.getLogger(__name__)

_AHEAD = 32  # batches read before they are asked for
_LOOK_AGAIN_S = 0.1


@dataclass(frozen=True, slots=True)
class PlacedBatch:
    batch: SensorBatch
    timeline: Timeline
    since_start_s: float  # of the source's own time


class SourceReader:
    """Hands over batches when they are due.

    ``speed`` plays a recording at that multiple of real time; None hands out as fast as
    batches are taken.  A live source paces itself.
    """

    def __init__(self, source: Source, clock: Clock, speed: float | None) -> None:
        self._source = source
        self._clock = clock
        self._pacer = None if source.is_live else Pacer(speed or 1.0)
        self._waits = speed is not None and not source.is_live
        self._ready: Queue[PlacedBatch] = Queue(_AHEAD)
        self._stop = Event()
        self._first_t_ns: int | None = None
        self.failure: str | None = None  # why the source ended before its end
        self._thread = Thread(target=self._run, name="source", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def take(self, timeout_s: float) -> PlacedBatch | None:
        """The next batch, or None when none is due in time or ever again (see ``ended``)."""
        try:
            return self._ready.get(timeout=timeout_s)
        except Empty:
            return None

    @property
    def ended(self) -> bool:
        """The source has no more, and everything has been taken."""
        return not self._thread.is_alive() and self._ready.empty()

    def close(self) -> None:
        """Let go of the source; a driver that hangs is left behind."""
        self._stop.set()
        self._source.close()
        self._thread.join(timeout=1.0)

    def _run(self) -> None:
        try:
            for placed in self._placed():
                if not self._hand_over(placed):
                    return
        except MusterError as error:
            self.failure = str(error)
        except Exception as error:  # a driver may fail in any way; the unit goes on without it
            logger.exception("the source failed")
            self.failure = f"{type(error).__name__}: {error}"

    def _placed(self) -> Iterator[PlacedBatch]:
        for batch in self._source.batches():
            times_ns = _bounds_ns(batch)
            if times_ns is None:
                continue
            first_ns, last_ns = times_ns
            if self._first_t_ns is None:
                self._first_t_ns = first_ns
            timeline = Timeline()
            if self._pacer is not None:
                timeline = self._pacer.place(first_ns, last_ns, self._clock.monotonic_ns())
                if self._waits and not self._wait_until(timeline.to_mono_ns(last_ns)):
                    return
            yield PlacedBatch(batch, timeline, (first_ns - self._first_t_ns) / NS_PER_S)

    def _wait_until(self, due_ns: int) -> bool:
        """False when told to stop meanwhile."""
        remaining_s = (due_ns - self._clock.monotonic_ns()) / NS_PER_S
        return not self._stop.wait(max(0.0, remaining_s))

    def _hand_over(self, placed: PlacedBatch) -> bool:
        while not self._stop.is_set():
            try:
                self._ready.put(placed, timeout=_LOOK_AGAIN_S)
            except Full:
                continue
            return True
        return False


def _bounds_ns(batch: SensorBatch) -> tuple[int, int] | None:
    """First and last time in a batch; None of an empty one."""
    if len(batch.imu):
        return int(batch.imu.t_ns[0]), int(batch.imu.t_ns[-1])
    times_ns = [sample.t_ns for sample in batch.others]
    return (min(times_ns), max(times_ns)) if times_ns else None
