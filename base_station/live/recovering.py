"""What people see while a station that starts is still reading its log: how far it is."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from threading import Event, Thread

from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.types import Receive, Scope, Send

from base_station.api.headers import SecurityHeaders
from base_station.config import HttpConfig
from base_station.live.surroundings import Record
from base_station.server import ConsoleServer
from shared.mcap_log import SegmentInfo

_PAGE_AFTER_S = 1.0  # most starts are over before
_SAID_EVERY_S = 5.0
_TOLD_EVERY = 1000  # records
_ASK_AGAIN_S = 2
_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Muster is starting</title>
<meta http-equiv="refresh" content="{again_s}">
<h1>The station is reading its log: {share:.0%}</h1>
<p>Units go on by themselves meanwhile, and what they say is fetched afterwards.
This page becomes the console when the station is ready.</p></html>
"""

Announce = Callable[[str], None]
Watch = Callable[[Iterable[Record]], Iterator[Record]]
_Answer = Callable[[Scope, Receive, Send], Awaitable[None]]


@contextmanager
def recovering(
    log: Sequence[SegmentInfo], listening: socket.socket, http: HttpConfig, announce: Announce
) -> Iterator[Watch]:
    """Gives a function for the records to be stepped to pass through, on their way from ``log``.

    Where that takes longer than a second, a page at the console's address says how far it is,
    and the API answers 503; ``announce`` says it every five seconds.  ``listening`` stays open.
    """
    progress = _Progress(listening, http, announce)
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
    def __init__(self, listening: socket.socket, http: HttpConfig, announce: Announce) -> None:
        self._listening = listening
        self._http = http
        self._announce = announce
        self._began_s = self._said_s = time.monotonic()
        self._share = 0.0
        self._page: _PageServer | None = None

    def tell(self, share: float) -> None:
        self._share = min(max(share, 0.0), 1.0)
        now_s = time.monotonic()
        if self._page is None and now_s - self._began_s > _PAGE_AFTER_S:
            self._page = _PageServer(self._listening, self._http, self._answer)
        if now_s - self._said_s > _SAID_EVERY_S:
            self._said_s = now_s
            self._announce(f"reading the log: {share:.0%}")

    def close(self) -> None:
        if self._page is not None:
            self._page.close()

    async def _answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close"})
        elif scope["type"] == "http":
            await self._response(scope["path"])(scope, receive, send)

    def _response(self, path: str) -> Response:
        headers = {"Retry-After": str(_ASK_AGAIN_S)}
        if path.startswith("/api/"):
            said = {"title": f"The station is reading its log: {self._share:.0%}", "status": 503}
            return JSONResponse(said, 503, headers, "application/problem+json")
        page = _PAGE.format(again_s=_ASK_AGAIN_S, share=self._share)
        return HTMLResponse(page, 503, headers)


class _PageServer:
    """Serves in a thread of its own, on a second handle to the socket."""

    def __init__(self, listening: socket.socket, http: HttpConfig, answer: _Answer) -> None:
        self._server = ConsoleServer(
            SecurityHeaders(answer, secure=http.certificate is not None),
            listening.dup(),
            http.certificate,
            http.private_key,
        )
        self._loop = asyncio.new_event_loop()
        self._started = Event()
        self._thread = Thread(target=self._run, name="recovering", daemon=True)
        self._thread.start()
        self._started.wait()

    def close(self) -> None:
        self._loop.call_soon_threadsafe(self._server.stop)
        self._thread.join()
        self._loop.close()

    def _run(self) -> None:
        self._loop.call_soon(self._started.set)
        self._loop.run_until_complete(self._server.serve())
