"""Admission of requests: slow ones take no thread from operator actions.

All routes share the framework's forty threads.  Log-ins have threads of their own, only some large
reads run at a time, and a client that has tried too many passwords is refused before its request is
read.  Uploads take turns in ``uploads``.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated, TypeVar

from fastapi import Depends, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from base_station.api.login_throttle import LoginThrottle, too_many_attempts
from base_station.api.problems import Problem, problem_response
from shared.coded_text import coded

T = TypeVar("T")

_LOGIN = re.compile(r"^/api/v1/login(/hand-over)?$")
_LARGE_READ = re.compile(r"^/api/v1/.*/(tracks?|trails|assessment|export/[^/]+)$")
_MAX_CONCURRENT_READS = 4
_MAX_WAITING_KNOWN = 20  # that wait: each takes a core a quarter of a second
_MAX_WAITING_UNKNOWN = 6


class AdmissionMiddleware:
    """ASGI middleware that limits log-ins and large reads."""

    def __init__(self, app: ASGIApp, throttle: LoginThrottle, queue: LoginQueue) -> None:
        self._app = app
        self._throttle = throttle
        self._queue = queue
        self._reading = asyncio.Semaphore(_MAX_CONCURRENT_READS)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        path = scope.get("path", "")
        if scope["type"] == "http" and _LOGIN.match(path) and scope["method"] == "POST":
            await self._log_in(scope, receive, send)
        elif scope["type"] == "http" and _LARGE_READ.match(path):
            await self._read_in_turn(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _log_in(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a login before its body is read."""
        address = scope["client"][0] if scope.get("client") else ""
        if not self._throttle.allows(address):
            refusal = too_many_attempts()
        elif not self._throttle.has_logged_in(address) and not self._queue.has_capacity_for_unknown:
            refusal = _too_many_logins()
        else:
            await self._app(scope, receive, send)
            return
        headers = {**(refusal.headers or {}), "Connection": "close"}
        answer = problem_response(refusal.status_code, refusal.detail, headers)
        await answer(scope, receive, send)

    async def _read_in_turn(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run a large read in its turn.  Its place is free again when the response begins: a slow
        reader delays no other request.
        """
        await self._reading.acquire()
        held = True

        async def send_and_release(message: Message) -> None:
            release()
            await send(message)

        def release() -> None:
            nonlocal held
            if held:
                held = False
                self._reading.release()

        try:
            await self._app(scope, receive, send_and_release)
        finally:
            release()


class LoginQueue:
    """Logins in the order in which they came, in a thread of their own.  A user name that has
    logged in from the same network before does not wait for other logins.
    """

    def __init__(self) -> None:
        self._known = _BoundedWorker("log-in-known", _MAX_WAITING_KNOWN)
        self._unknown = _BoundedWorker("log-in", _MAX_WAITING_UNKNOWN)

    async def run(self, work: Callable[[], T], *, is_known: bool) -> T:
        """Run a login in its turn, from the event loop.  Problem 503 if too many wait."""
        return await (self._known if is_known else self._unknown).run(work)

    @property
    def has_capacity_for_unknown(self) -> bool:
        return self._unknown.has_capacity

    def close(self) -> None:
        for worker in (self._known, self._unknown):
            worker.thread.shutdown(wait=False, cancel_futures=True)


class _BoundedWorker:
    """Worker thread with a limited number of waiting requests."""

    def __init__(self, name: str, max_pending: int) -> None:
        self.thread = ThreadPoolExecutor(1, name)
        self._max_pending = max_pending
        self._pending = 0

    @property
    def has_capacity(self) -> bool:
        return self._pending < self._max_pending

    async def run(self, work: Callable[[], T]) -> T:
        if not self.has_capacity:
            raise _too_many_logins()
        self._pending += 1
        try:
            return await asyncio.get_running_loop().run_in_executor(self.thread, work)
        finally:
            self._pending -= 1


def _too_many_logins() -> Problem:
    detail = coded(
        "logins-too-many", "Too many people log in at the moment; try again in a few seconds."
    )
    return Problem(503, detail, {"Retry-After": "5"})


def queue_of(request: Request) -> LoginQueue:
    queue: LoginQueue = request.app.state.login_queue
    return queue


Queue = Annotated[LoginQueue, Depends(queue_of)]
