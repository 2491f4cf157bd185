"""Reader of lines of text, in a thread of its own, from hardware that may be gone or silent."""

from __future__ import annotations

import logging
from contextlib import closing
from typing import Protocol

from edge.sources.transport.connection import Connection
from shared.clock import Clock
from shared.worker import Worker

logger = logging.getLogger(__name__)

_RETRY_S = 1.0
_JOIN_TIMEOUT_S = 2.0  # for a thread to end: more than a read waits


class LineHandler(Protocol):
    """Handler of lines; only ever called by the one thread."""

    def open(self) -> Connection:
        """Raises OSError."""
        ...

    def on_open(self) -> None:
        """Handle a new connection: a half-read line is gone."""
        ...

    def on_line(self, line: bytes, began_ns: int) -> None:
        """Handle a line without its end, the first byte of which came at ``began_ns``
        (monotonic).
        """
        ...

    def keeps_open(self, now_ns: int, *, paused: bool) -> bool:
        """Return False where the connection is of no use and should be opened again; called
        after data, or with ``paused`` after half a second of nothing.
        """
        ...

    def on_close(self, error: OSError | None) -> None:
        """Handle the end of the connection; ``error`` None: the other end has closed it."""
        ...


class LineReader:
    """Reader that opens the connection again whenever it ends, until ``close``."""

    def __init__(self, name: str, handler: LineHandler, longest: int, clock: Clock) -> None:
        self._handler = handler
        self._longest = longest
        self._clock = clock
        self._worker = Worker(name, self._step, f"the lines of {name} are not read")

    @property
    def is_alive(self) -> bool:
        return self._worker.is_alive

    def start(self) -> None:
        self._worker.start()

    def close(self) -> None:
        self._worker.close(_JOIN_TIMEOUT_S)

    def _step(self) -> float:
        """Open the connection, and read until it ends."""
        try:
            with closing(self._handler.open()) as line:
                self._handler.on_open()
                self._read_lines(line)
        except OSError as error:
            self._handler.on_close(error)
        except Exception as error:
            logger.exception("what came on a line could not be dealt with")
            self._handler.on_close(OSError(f"{type(error).__name__}: {error}"))
        return _RETRY_S

    def _read_lines(self, line: Connection) -> None:
        """Read until the connection ends or is of no use."""
        remainder, began_ns = b"", 0
        while not self._worker.stopping.is_set():
            data = line.read()
            now_ns = self._clock.monotonic_ns()
            if data == b"":
                self._handler.on_close(None)
                return
            if data:
                began_ns = began_ns if remainder else now_ns
                *lines, remainder = (remainder + data).split(b"\n")
                for one in lines:
                    self._handler.on_line(one, began_ns)
                    began_ns = now_ns
                if len(remainder) > self._longest:
                    self._handler.on_line(remainder, began_ns)
                    remainder = b""
            if not self._handler.keeps_open(now_ns, paused=data is None):
                return
