"""Reads a source in a thread of its own, so that a sensor that hangs silences nothing else.

What is read beside it (beacons, satellites) goes with the next batch; while a live source gives
none, by itself.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from queue import Empty, Full, Queue
from threading import Event, Thread

import numpy as np

from edge.clocks.timeline import Pacer, Timekeeper, Timeline
from edge.samples import ImuBatch, OtherSample, SensorBatch
from edge.sources.port import Beside, Source, TellsFaults
from shared.clock import NS_PER_S, Clock
from shared.errors import MusterError

logger = logging.getLogger(__name__)

_AHEAD = 32  # batches read before they are asked for
_LOOK_AGAIN_S = 0.1
_ALONE_NS = NS_PER_S  # without a batch, after which what is read beside waits no longer


_NO_IMU = ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))


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

    def __init__(
        self,
        source: Source,
        clock: Clock,
        speed: float | None,
        beside: tuple[Beside, ...] = (),
        timekeeper: Timekeeper | None = None,
    ) -> None:
        """``timekeeper``: of a source that is not live; None: its times are a recording's."""
        self._source = source
        self._beside = beside
        self._clock = clock
        self._timekeeper = None if source.is_live else timekeeper or Pacer(speed or 1.0)
        self._waits = speed is not None and not source.is_live
        self._ready: Queue[PlacedBatch] = Queue(_AHEAD)
        self._stop = Event()
        self._first_t_ns: int | None = None
        self._taken_ns = clock.monotonic_ns()  # when the last batch was
        self.failure: str | None = None  # why the source ended before its end
        self._thread = Thread(target=self._run, name="source", daemon=True)

    def start(self) -> None:
        self._taken_ns = self._clock.monotonic_ns()
        self._thread.start()
        for one in self._beside:
            one.start()

    def take(self, timeout_s: float) -> PlacedBatch | None:
        """The next batch, or None when none is due in time or ever again (see ``ended``)."""
        try:
            placed = self._ready.get(timeout=timeout_s)
        except Empty:
            return self._beside_alone()
        self._taken_ns = self._clock.monotonic_ns()
        return self._with_beside(placed)

    def take_faults(self) -> tuple[str, ...]:
        """What a person must hear of the source and what is beside it since the last call."""
        tellers = (one for one in (self._source, *self._beside) if isinstance(one, TellsFaults))
        return tuple(chain.from_iterable(one.take_faults() for one in tellers))

    @property
    def ended(self) -> bool:
        """The source has no more, and everything has been taken."""
        return not self._thread.is_alive() and self._ready.empty()

    def close(self) -> None:
        """Let go of the source; a driver that hangs is left behind."""
        self._stop.set()
        self._source.close()
        for one in self._beside:
            one.close()
        self._thread.join(timeout=1.0)

    def _with_beside(self, placed: PlacedBatch) -> PlacedBatch:
        """The times beside a source are this machine's; where the source's are not, what came is of
        the batch with which it comes.
        """
        came = self._came()
        times_ns = None if self._source.is_live else _bounds_ns(placed.batch)
        if times_ns is not None:
            came = tuple(replace(one, t_ns=times_ns[1]) for one in came)
        if not came:
            return placed
        batch = replace(placed.batch, others=(*placed.batch.others, *came))
        return replace(placed, batch=batch)

    def _beside_alone(self) -> PlacedBatch | None:
        if not self._source.is_live or self._clock.monotonic_ns() - self._taken_ns < _ALONE_NS:
            return None
        came = self._came()
        return PlacedBatch(SensorBatch(_NO_IMU, came), Timeline(), 0.0) if came else None

    def _came(self) -> tuple[OtherSample, ...]:
        return tuple(chain.from_iterable(one.take() for one in self._beside))

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
            if self._timekeeper is not None:
                timeline = self._timekeeper.place(first_ns, last_ns, self._clock.monotonic_ns())
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
