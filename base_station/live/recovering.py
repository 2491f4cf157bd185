"""What people see while a station that starts is still reading its log: what was last stored."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from threading import Event, Thread

from starlette.types import ASGIApp

from base_station.api.server import ConsoleServer
from base_station.config import HttpConfig
from base_station.live.drive_ports import Record
from shared.mcap_log import SegmentInfo

_SHOWN_AFTER_S = 1.0  # most starts are over before
_SAID_EVERY_S = 5.0
_TOLD_EVERY = 1000  # records

Announce = Callable[[str], None]
Watch = Callable[[Iterable[Record]], Iterator[Record]]
Tell = Callable[[float], None]  # how much of the log is read, 0..1


@contextmanager
def recovering(
    log: Sequence[SegmentInfo],
    listening: socket.socket,
    http: HttpConfig,
    early: Callable[[], tuple[ASGIApp, Tell]],
    announce: Announce,
) -> Iterator[Watch]:
    """Gives a function for the records to be stepped to pass through, on their way from ``log``.

    Where that takes longer than a second, the application of ``early`` is at the console's address
    and is told how far it is; ``announce`` says it every five seconds.  ``listening`` stays open.
    """
    progress = _Progress(listening, http, early, announce)
    end_ns = max((segment.end_ns for segment in log), default=0)

    def watched(records: Iterable[Record]) -> Iterator[Record]:
        first_ns = 0
        for number, record in enumerate(records):
            if number % _TOLD_EVERY == 0:
                first_ns = first_ns or record[0]
                progress.tell((record[0] - first_ns) / max(end_ns - first_ns, 1))
            yield record

    try:
        yield watched
    finally:
        progress.close()


class _Progress:
    def __init__(
        self,
        listening: socket.socket,
        http: HttpConfig,
        early: Callable[[], tuple[ASGIApp, Tell]],
        announce: Announce,
    ) -> None:
        self._listening = listening
        self._http = http
        self._early = early
        self._announce = announce
        self._began_s = self._said_s = time.monotonic()
        self._server: _EarlyServer | None = None
        self._tell: Tell = lambda _: None

    def tell(self, share: float) -> None:
        share = min(max(share, 0.0), 1.0)
        now_s = time.monotonic()
        if self._server is None and now_s - self._began_s > _SHOWN_AFTER_S:
            app, self._tell = self._early()
            self._server = _EarlyServer(app, self._listening, self._http)
        self._tell(share)
        if now_s - self._said_s > _SAID_EVERY_S:
            self._said_s = now_s
            self._announce(f"reading the log: {share:.0%}")

    def close(self) -> None:
        if self._server is not None:
            self._server.close()


class _EarlyServer:
    """Serves in a thread of its own, on a second handle to the socket."""

    def __init__(self, app: ASGIApp, listening: socket.socket, http: HttpConfig) -> None:
        self._server = ConsoleServer(app, listening.dup(), http.certificate, http.private_key)
        # Ends with the loop what is under way, as a greeting of TLS; it is no loop of this thread.
        self._runner = asyncio.Runner(loop_factory=asyncio.new_event_loop)
        self._loop = self._runner.get_loop()
        self._started = Event()
        self._thread = Thread(target=self._run, name="recovering", daemon=True)
        self._thread.start()
        self._started.wait()

    def close(self) -> None:
        self._loop.call_soon_threadsafe(self._server.stop)
        self._thread.join()
        self._runner.close()

    def _run(self) -> None:
        self._loop.call_soon(self._started.set)
        self._runner.run(self._server.serve())
