"""Reader of a source in a thread of its own, so that a sensor that hangs blocks nothing else.

Samples of auxiliaries (beacons, satellites) go with the next batch; while a live source gives none,
they go alone.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from queue import Empty, Full, Queue
from threading import Event, Thread

import numpy as np

from edge.clocks.timeline import Pacer, Timekeeper, Timeline
from edge.samples import ButtonPress, ImuBatch, OtherSample, SensorBatch
from edge.sources.interface import AuxiliarySource, ReportsFaults, Source
from shared.clock import NS_PER_S, Clock
from shared.errors import MusterError

logger = logging.getLogger(__name__)

_QUEUE_SIZE = 32  # batches read ahead
_PUT_TIMEOUT_S = 0.1
_SAME_CLOCK_NS = 10 * NS_PER_S  # sensors whose times differ by more are on clocks of their own
_AUXILIARY_WAIT_NS = NS_PER_S  # without a batch; then auxiliary samples wait no longer


_NO_IMU = ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))


@dataclass(frozen=True, slots=True)
class TimedBatch:
    batch: SensorBatch
    timeline: Timeline
    since_start_s: float  # of the source's own time


class SourceReader:
    """Reader that hands over batches when they are due.

    ``speed`` plays a recording at that multiple of real time; None hands out as fast as
    batches are taken.  A live source paces itself.
    """

    def __init__(
        self,
        source: Source,
        clock: Clock,
        speed: float | None,
        auxiliaries: tuple[AuxiliarySource, ...] = (),
        timekeeper: Callable[[], Timekeeper] | None = None,
    ) -> None:
        """``timekeeper``: makes that of a sensor that is not live; None: its times are a
        recording's.
        """
        self._source = source
        self._auxiliaries = auxiliaries
        self._clock = clock
        self._new_timekeeper = timekeeper or (lambda: Pacer(speed or 1.0))
        self._timekeepers: dict[str, Timekeeper] = {}  # by sensor: each may have its own clock
        self._newest_ns: dict[str, int] = {}  # by sensor, on its clock
        self._is_paced = speed is not None and not source.is_live
        self._ready: Queue[TimedBatch] = Queue(_QUEUE_SIZE)
        self._stop = Event()
        self._first_t_ns: int | None = None
        self._taken_ns = clock.monotonic_ns()  # when the last batch was
        self.failure: str | None = None  # why the source ended before its end
        self._thread = Thread(target=self._run, name="source", daemon=True)

    def start(self) -> None:
        self._taken_ns = self._clock.monotonic_ns()
        self._thread.start()
        for one in self._auxiliaries:
            one.start()

    def take(self, timeout_s: float) -> TimedBatch | None:
        """Return the next batch, or None when none is due in time or ever again (see ``ended``)."""
        try:
            timed = self._ready.get(timeout=timeout_s)
        except Empty:
            return self._auxiliary_alone()
        self._taken_ns = self._clock.monotonic_ns()
        return self._with_auxiliary(timed)

    def take_faults(self) -> tuple[str, ...]:
        """Return new faults of the source and its auxiliaries, for a person."""
        reporters = (
            one for one in (self._source, *self._auxiliaries) if isinstance(one, ReportsFaults)
        )
        return tuple(chain.from_iterable(one.take_faults() for one in reporters))

    def last_presses(self) -> tuple[ButtonPress, ...]:
        """Return presses of auxiliary buttons that went with no batch; called after closing, for a
        press while the source or the agent failed.
        """
        return tuple(one for one in self._take_auxiliary() if isinstance(one, ButtonPress))

    @property
    def ended(self) -> bool:
        """True when the source has ended, and all batches were taken."""
        return not self._thread.is_alive() and self._ready.empty()

    def close(self) -> None:
        """Close the source, without waiting for a driver that hangs."""
        self._stop.set()
        self._source.close()
        for one in self._auxiliaries:
            one.close()
        self._thread.join(timeout=1.0)

    def _with_auxiliary(self, timed: TimedBatch) -> TimedBatch:
        """Add the auxiliaries' samples.  Their times are this machine's; where the source's are
        not, they get the time of the batch with which they come.
        """
        samples = self._take_auxiliary()
        times_ns = None if self._source.is_live else _bounds_ns(timed.batch)
        if times_ns is not None:
            samples = tuple(replace(one, t_ns=times_ns[1]) for one in samples)
        if not samples:
            return timed
        batch = replace(timed.batch, others=(*timed.batch.others, *samples))
        return replace(timed, batch=batch)

    def _auxiliary_alone(self) -> TimedBatch | None:
        if (
            not self._source.is_live
            or self._clock.monotonic_ns() - self._taken_ns < _AUXILIARY_WAIT_NS
        ):
            return None
        samples = self._take_auxiliary()
        return TimedBatch(SensorBatch(_NO_IMU, samples), Timeline(), 0.0) if samples else None

    def _take_auxiliary(self) -> tuple[OtherSample, ...]:
        return tuple(chain.from_iterable(one.take() for one in self._auxiliaries))

    def _run(self) -> None:
        try:
            for timed in self._timed_batches():
                if not self._enqueue(timed):
                    return
        except MusterError as error:
            self.failure = str(error)
        except Exception as error:  # a driver may fail in any way; the unit goes on without it
            logger.exception("the source failed")
            self.failure = f"{type(error).__name__}: {error}"

    def _timed_batches(self) -> Iterator[TimedBatch]:
        for batch in self._source.batches():
            times_ns = _bounds_ns(batch)
            if times_ns is None:
                continue
            first_ns, last_ns = times_ns
            if self._first_t_ns is None:
                self._first_t_ns = first_ns
            timeline = Timeline()
            if not self._source.is_live:
                timekeeper = self._timekeeper(batch.sensor, first_ns)
                timeline = timekeeper.place(first_ns, last_ns, self._clock.monotonic_ns())
                self._newest_ns[batch.sensor] = last_ns
                if self._is_paced and not self._wait_until(timeline.to_mono_ns(last_ns)):
                    return
            yield TimedBatch(batch, timeline, (first_ns - self._first_t_ns) / NS_PER_S)

    def _timekeeper(self, sensor: str, first_ns: int) -> Timekeeper:
        """Return the sensor's timekeeper, which sensors on one clock share."""
        if sensor not in self._timekeepers:
            for other, newest_ns in self._newest_ns.items():
                if abs(first_ns - newest_ns) < _SAME_CLOCK_NS:
                    self._timekeepers[sensor] = self._timekeepers[other]
                    return self._timekeepers[sensor]
            self._timekeepers[sensor] = self._new_timekeeper()
        return self._timekeepers[sensor]

    def _wait_until(self, due_ns: int) -> bool:
        """Wait; return False when stopped meanwhile."""
        remaining_s = (due_ns - self._clock.monotonic_ns()) / NS_PER_S
        return not self._stop.wait(max(0.0, remaining_s))

    def _enqueue(self, timed: TimedBatch) -> bool:
        while not self._stop.is_set():
            try:
                self._ready.put(timed, timeout=_PUT_TIMEOUT_S)
            except Full:
                continue
            return True
        return False


def _bounds_ns(batch: SensorBatch) -> tuple[int, int] | None:
    """Return first and last time in a batch; None of an empty one."""
    if len(batch.imu):
        return int(batch.imu.t_ns[0]), int(batch.imu.t_ns[-1])
    times_ns = [sample.t_ns for sample in batch.others]
    return (min(times_ns), max(times_ns)) if times_ns else None
