"""Listens to lines of text, in a thread of its own, where hardware may be gone or silent."""

from __future__ import annotations

import logging
from contextlib import closing
from threading import Event, Thread
from typing import Protocol

from edge.sources.line import Line
from shared.clock import Clock

logger = logging.getLogger(__name__)

_AGAIN_S = 1.0
_END_S = 2.0  # for a thread to end: more than a read waits


class Listener(Protocol):
    """Makes something of what is said; only ever called by the one thread."""

    def open(self) -> Line:
        """Raises OSError."""
        ...

    def opened(self) -> None:
        """The line is open: what was half said before is gone."""
        ...

    def hear(self, line: bytes, began_ns: int) -> None:
        """A line without its end, the first byte of which came at ``began_ns`` (monotonic)."""
        ...

    def turn(self, now_ns: int, *, paused: bool) -> bool:
        """After what came, or with ``paused`` after half a second of nothing; false where the line
        is of no use and should be opened again.
        """
        ...

    def gone(self, error: OSError | None) -> None:
        """Why the line cannot be opened or read; None: the other end has ended it."""
        ...


class LineThread:
    """Opens the line again whenever it ends, until ``close``."""

    def __init__(self, name: str, listener: Listener, longest: int, clock: Clock) -> None:
        self._listener = listener
        self._longest = longest
        self._clock = clock
        self._stop = Event()
        self._thread = Thread(target=self._run, name=name, daemon=True)

    @property
    def is_alive(self) -> bool:
        return self._thread.is_alive()

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=_END_S)

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                with closing(self._listener.open()) as line:
                    self._listener.opened()
                    self._listen(line)
            except OSError as error:
                self._listener.gone(error)
            except Exception as error:  # what comes from outside must not end it for good
                logger.exception("what came on a line could not be dealt with")
                self._listener.gone(OSError(f"{type(error).__name__}: {error}"))
            self._stop.wait(_AGAIN_S)

    def _listen(self, line: Line) -> None:
        """Until it ends or is of no use."""
        rest, began_ns = b"", 0
        while not self._stop.is_set():
            said = line.read()
            now_ns = self._clock.monotonic_ns()
            if said == b"":
                self._listener.gone(None)
                return
            if said:
                began_ns = began_ns if rest else now_ns
                *lines, rest = (rest + said).split(b"\n")
                for one in lines:
                    self._listener.hear(one, began_ns)
                    began_ns = now_ns
                if len(rest) > self._longest:
                    self._listener.hear(rest, began_ns)
                    rest = b""
            if not self._listener.turn(now_ns, paused=said is None):
                return
