"""A source with a reader of beacons beside it.

The reader is a serial port, a named pipe or a TCP server that says a line for each thing seen
(``sighting_lines``).  It has a thread of its own: one that is silent, gone or talks nonsense delays
nothing, and is opened again when it can be.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from threading import Event, Thread

from edge.samples import SensorBatch, SensorDescription, SightingSample
from edge.sources.line import DeviceLine, Line, SocketLine
from edge.sources.port import Outage, Source, TellsFaults
from edge.sources.sighting_lines import LONGEST, sighting_of
from shared.clock import Clock
from shared.errors import ConfigError, WireError

logger = logging.getLogger(__name__)

MOST_WAITING = 500  # sightings: the oldest are left out
_LOOK_S = 0.5
_AGAIN_S = 2.0
_TALL = 20  # complaints about lines, then only counts


def open_reader(text: str) -> Callable[[], Line]:
    """How to open what ``tcp:HOST:PORT`` or ``PATH`` names.  Raises ConfigError."""
    if not text.startswith("tcp:"):
        return lambda: DeviceLine(text)
    host, _, port = text.removeprefix("tcp:").rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ConfigError(f"a reader is tcp:HOST:PORT or a device's path, not {text!r}")
    return lambda: SocketLine(host.strip("[]"), int(port))


class WithReader:
    """``source`` with what the reader saw put into its batches."""

    def __init__(self, source: Source, reader: str, clock: Clock) -> None:
        self._source = source
        self._name = reader
        self._open = open_reader(reader)
        self._clock = clock
        self._seen: deque[SightingSample] = deque(maxlen=MOST_WAITING)
        self._stop = Event()
        self.bad_lines = 0
        self._thread = Thread(target=self._run, name="reader", daemon=True)

    @property
    def description(self) -> SensorDescription:
        return self._source.description

    @property
    def is_live(self) -> bool:
        return self._source.is_live

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return self._source.radio_outages

    def take_faults(self) -> tuple[str, ...]:
        return self._source.take_faults() if isinstance(self._source, TellsFaults) else ()

    def batches(self) -> Iterator[SensorBatch]:
        """The source's times are this machine's where it is live; else a sighting is of the batch
        with which it comes.
        """
        self._thread.start()
        for batch in self._source.batches():
            seen = tuple(self._seen.popleft() for _ in range(len(self._seen)))
            if seen and not self._source.is_live and len(batch.imu):
                last_ns = int(batch.imu.t_ns[-1])
                seen = tuple(replace(one, t_ns=last_ns) for one in seen)
            yield replace(batch, others=(*batch.others, *seen)) if seen else batch

    def close(self) -> None:
        self._stop.set()
        self._source.close()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0 * _LOOK_S)

    def _run(self) -> None:
        complained = False
        while not self._stop.is_set():
            try:
                with closing(self._open()) as stream:
                    logger.info("the reader %s is open", self._name)
                    complained = False
                    self._listen(stream)
            except OSError as error:
                if not complained:
                    logger.warning("the reader %s cannot be read: %s", self._name, error)
                complained = True
            self._stop.wait(_AGAIN_S)

    def _listen(self, stream: Line) -> None:
        """Until it ends."""
        rest = b""
        while not self._stop.is_set():
            said = stream.read()
            if said is None:
                continue
            if not said:
                return
            *lines, rest = (rest + said).split(b"\n")
            for line in lines:
                self._take(line)
            if len(rest) > LONGEST:
                self._take(rest)
                rest = b""

    def _take(self, line: bytes) -> None:
        try:
            seen = sighting_of(line.decode("ascii", "replace"), self._clock.monotonic_ns())
        except WireError as error:
            self.bad_lines += 1
            if self.bad_lines <= _TALL:
                logger.warning("the reader %s says something else: %s", self._name, error)
            return
        if seen is not None:
            self._seen.append(seen)
