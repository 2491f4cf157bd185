"""A reader of beacons beside a source.

It is a serial port, a named pipe or a TCP server that says a line for each thing seen
(``sighting_lines``).
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable

from edge.samples import SightingSample
from edge.sources.line import DeviceLine, Line, SocketLine
from edge.sources.line_place import server_of
from edge.sources.line_thread import LineThread
from edge.sources.sighting_lines import LONGEST, sighting_of
from shared.clock import Clock
from shared.errors import ConfigError, WireError

logger = logging.getLogger(__name__)

MOST_WAITING = 500  # sightings: the oldest are left out
_MOST_COMPLAINTS = 20  # about lines; then they are only counted


def open_reader(text: str) -> Callable[[], Line]:
    """How to open what ``tcp:HOST:PORT`` or ``PATH`` names.  Raises ConfigError."""
    if not text.startswith("tcp:"):
        return lambda: DeviceLine(text)
    server = text.removeprefix("tcp:").removeprefix("//")
    host, port, path = server_of(f"tcp://{server}", None) or ("", 0, "")
    if not host or path not in ("", "/"):
        raise ConfigError(f"a reader is tcp:HOST:PORT or a device's path, not {text!r}")
    return lambda: SocketLine(host, port)


class SightingReader:
    """Gives what the reader ``text`` names saw."""

    def __init__(self, text: str, clock: Clock) -> None:
        """Raises ConfigError."""
        self._name = text
        self._open = open_reader(text)
        self._seen: deque[SightingSample] = deque(maxlen=MOST_WAITING)
        self._complained = False
        self.bad_lines = 0
        self._thread = LineThread("sightings", self, LONGEST, clock)

    def start(self) -> None:
        self._thread.start()

    def take(self) -> tuple[SightingSample, ...]:
        return tuple(self._seen.popleft() for _ in range(len(self._seen)))

    def take_faults(self) -> tuple[str, ...]:
        """None: what it misses is logged, and nobody is in danger for it."""
        return ()

    def close(self) -> None:
        self._thread.close()

    def open(self) -> Line:
        return self._open()

    def opened(self) -> None:
        logger.info("the reader %s is open", self._name)
        self._complained = False

    def hear(self, line: bytes, began_ns: int) -> None:
        try:
            seen = sighting_of(line.decode("ascii", "replace"), began_ns)
        except WireError as error:
            self.bad_lines += 1
            if self.bad_lines <= _MOST_COMPLAINTS:
                logger.warning("the reader %s says something else: %s", self._name, error)
            return
        if seen is not None:
            self._seen.append(seen)

    def turn(self, now_ns: int, *, paused: bool) -> bool:  # noqa: ARG002  # silence is its right
        return True

    def gone(self, error: OSError | None) -> None:
        if error is not None and not self._complained:
            logger.warning("the reader %s cannot be read: %s", self._name, error)
            self._complained = True
