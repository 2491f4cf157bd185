"""Auxiliary source: a reader of beacons and tags.

It is a serial port, a named pipe or a TCP server that says a line for each thing seen
(``sighting_lines``).
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable

from edge.samples import SightingSample
from edge.sources.sighting_format import LONGEST, sighting_of
from edge.sources.transport.address import parse_server
from edge.sources.transport.connection import Connection, DeviceConnection, TcpConnection
from edge.sources.transport.line_reader import LineReader
from shared.clock import Clock
from shared.errors import ConfigError, WireError

logger = logging.getLogger(__name__)

SIGHTINGS_MAX = 500  # sightings: the oldest are left out
_LOGGED_ERRORS_MAX = 20  # about lines; then they are only counted


def open_reader(text: str) -> Callable[[], Connection]:
    """Return a function that opens what ``tcp:HOST:PORT`` or ``PATH`` names.  Raises
    ConfigError.
    """
    if not text.startswith("tcp:"):
        return lambda: DeviceConnection(text)
    server = text.removeprefix("tcp:").removeprefix("//")
    host, port, path = parse_server(f"tcp://{server}", None) or ("", 0, "")
    if not host or path not in ("", "/"):
        raise ConfigError(f"a reader is tcp:HOST:PORT or a device's path, not {text!r}")
    return lambda: TcpConnection(host, port)


class SightingReader:
    """Source of the sightings of the reader ``text`` names."""

    def __init__(self, text: str, clock: Clock) -> None:
        """Raises ConfigError."""
        self._name = text
        self._open = open_reader(text)
        self._seen: deque[SightingSample] = deque(maxlen=SIGHTINGS_MAX)
        self._error_logged = False
        self.bad_lines = 0
        self._thread = LineReader("sightings", self, LONGEST, clock)

    def start(self) -> None:
        self._thread.start()

    def take(self) -> tuple[SightingSample, ...]:
        return tuple(self._seen.popleft() for _ in range(len(self._seen)))

    def take_faults(self) -> tuple[str, ...]:
        """Return none: a missed sighting is logged, and endangers no one."""
        return ()

    def close(self) -> None:
        self._thread.close()

    def open(self) -> Connection:
        return self._open()

    def on_open(self) -> None:
        logger.info("the reader %s is open", self._name)
        self._error_logged = False

    def on_line(self, line: bytes, began_ns: int) -> None:
        try:
            seen = sighting_of(line.decode("ascii", "replace"), began_ns)
        except WireError as error:
            self.bad_lines += 1
            if self.bad_lines <= _LOGGED_ERRORS_MAX:
                logger.warning("the reader %s says something else: %s", self._name, error)
            return
        if seen is not None:
            self._seen.append(seen)

    def keeps_open(self, now_ns: int, *, paused: bool) -> bool:  # noqa: ARG002  # silence is its right
        return True

    def on_close(self, error: OSError | None) -> None:
        if error is not None and not self._error_logged:
            logger.warning("the reader %s cannot be read: %s", self._name, error)
            self._error_logged = True
