"""Group of sources of one person's sensors as one source, whose batches name their sensor.

Recordings and simulations are merged by time, or by the time since their start where their clocks
have nothing to do with each other.  Hardware is read by a thread for each sensor: one that hangs,
fails or ends takes none of the others with it.
"""

from __future__ import annotations

import heapq
import logging
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import replace
from queue import Empty, Full, Queue
from threading import Event, Thread

from edge.fault_texts import fault_of, program_error
from edge.samples import BatterySample, OtherSample, SensorBatch, SensorDescription
from edge.sources.interface import Outage, ReportsFaults, Source
from shared.clock import NS_PER_S
from shared.coded_text import CodedText, coded
from shared.errors import ConfigError, MusterError, RecordingError

logger = logging.getLogger(__name__)

_SAME_CLOCK_NS = 10 * NS_PER_S  # recordings that begin farther apart are of different clocks
_WAIT_S = 0.1
_QUEUE_SIZE = 256  # batches of hardware that wait


class SensorGroup:
    """Group; it ends when the last of its sources does."""

    def __init__(self, members: Mapping[str, Source]) -> None:
        """``members``: by the names of their sensors.  Raises ConfigError where some are hardware
        and others not, as their times cannot be compared.
        """
        if len({one.is_live for one in members.values()}) > 1:
            raise ConfigError(
                "sensors of one person are either all hardware or all recorded or simulated; "
                f"{', '.join(members)} are of both kinds"
            )
        self._members = dict(members)
        self._faults: deque[str] = deque()
        self._last_failure: str | None = None
        self._closed = Event()

    @property
    def description(self) -> SensorDescription:
        return next(iter(self.sensors.values()))

    @property
    def sensors(self) -> dict[str, SensorDescription]:
        return {name: source.description for name, source in self._members.items()}

    @property
    def is_live(self) -> bool:
        return next(iter(self._members.values())).is_live

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return next(iter(self._members.values())).radio_outages

    def batches(self) -> Iterator[SensorBatch]:
        """Yield the batches of all.  Raises RecordingError where the last one left has failed."""
        yield from self._live_batches() if self.is_live else self._merged_batches()
        if self._last_failure is not None and not self._closed.is_set():
            raise RecordingError(self._last_failure)

    def take_faults(self) -> tuple[str, ...]:
        faults: list[str] = []
        while self._faults:
            faults.append(self._faults.popleft())
        for name, source in self._members.items():
            if isinstance(source, ReportsFaults):
                faults += [fault_of(name, fault) for fault in source.take_faults()]
        return tuple(faults)

    def close(self) -> None:
        self._closed.set()
        for source in self._members.values():
            source.close()

    def _batches_of(self, name: str) -> Iterator[SensorBatch]:
        """Yield the batches of one, with its name; at its end report that, and a failure."""
        try:
            for batch in self._members[name].batches():
                others = tuple(_named(other, name) for other in batch.others)
                yield replace(batch, others=others, sensor=name)
        except MusterError as error:
            self._note_end(name, _failed(str(error)))
        except Exception as error:  # a driver may fail in any way; the others go on
            logger.exception("the source of %s failed", name)
            self._note_end(name, _failed(program_error(error)))
        else:
            self._note_end(name, None)

    def _note_end(self, name: str, failure: str | None) -> None:
        self._last_failure = None if failure is None else f"{name}: {failure}"
        if not self._closed.is_set():
            ended = coded("source-ended", "its source has no more")
            self._faults.append(fault_of(name, failure or ended))

    def _merged_batches(self) -> Iterator[SensorBatch]:
        streams = [
            _Stream(self._batches_of(name), order) for order, name in enumerate(self._members)
        ]
        waiting = [stream for stream in streams if stream.advance()]
        firsts_ns = [stream.due_ns for stream in waiting]
        if firsts_ns and max(firsts_ns) - min(firsts_ns) > _SAME_CLOCK_NS:
            for stream in waiting:
                stream.start()
        heapq.heapify(waiting)
        while waiting and not self._closed.is_set():
            stream = waiting[0]
            yield stream.batch
            if stream.advance():
                heapq.heapreplace(waiting, stream)
            else:
                heapq.heappop(waiting)

    def _live_batches(self) -> Iterator[SensorBatch]:
        ready: Queue[SensorBatch] = Queue(_QUEUE_SIZE)

        def read(name: str) -> None:
            for batch in self._batches_of(name):
                if not self._enqueue(ready, batch):
                    return

        threads = [
            Thread(target=read, args=(name,), name=f"source-{name}", daemon=True)
            for name in self._members
        ]
        for thread in threads:
            thread.start()
        while not self._closed.is_set():
            is_over = not any(thread.is_alive() for thread in threads)
            try:
                yield ready.get(timeout=0.0 if is_over else _WAIT_S)
            except Empty:
                if is_over:
                    return

    def _enqueue(self, ready: Queue[SensorBatch], batch: SensorBatch) -> bool:
        """Wait until there is room; return False when closed meanwhile."""
        while not self._closed.is_set():
            try:
                ready.put(batch, timeout=_WAIT_S)
            except Full:
                continue
            return True
        return False


class _Stream:
    """Batches of one sensor, of which the next one is known."""

    def __init__(self, batches: Iterator[SensorBatch], order: int) -> None:
        self._batches = batches
        self._order = order
        self._origin_ns = 0
        self.due_ns = 0
        self.batch: SensorBatch

    def advance(self) -> bool:
        """Take the next batch; return False at the end."""
        for batch in self._batches:
            times_ns = [sample.t_ns for sample in batch.others]
            if len(batch.imu):
                times_ns = [int(batch.imu.t_ns[0])]
            if times_ns:
                self.batch, self.due_ns = batch, min(times_ns) - self._origin_ns
                return True
        return False

    def start(self) -> None:
        """Count time from the batch that is next."""
        self._origin_ns, self.due_ns = self.due_ns, 0

    def __lt__(self, other: _Stream) -> bool:
        return (self.due_ns, self._order) < (other.due_ns, other._order)


def _failed(error: str) -> CodedText:
    return coded("source-failed", "it has failed: {error}", error=error)


def _named(sample: OtherSample, name: str) -> OtherSample:
    """Return the sample; a battery of the sensor gets the sensor's name."""
    if isinstance(sample, BatterySample) and not sample.battery:
        return replace(sample, battery=name)
    return sample
