"""Turns of uploads: pictures and plans are read a few at a time, and no account holds up another.

A body of 12 MB stays in memory until it is worked on.  All others wait at the sender's, whose TCP
holds them back; accounts take turns.  A slow body keeps its turn for as long as no other body
waits.
"""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import asynccontextmanager
from typing import Any

from fastapi import Request, Response
from fastapi.routing import APIRoute
from starlette.concurrency import run_in_threadpool
from starlette.types import Message, Receive

from base_station.api.authentication import principal_of, unauthenticated
from base_station.api.forms import MAX_UPLOAD_BYTES
from base_station.api.problems import Problem
from base_station.api.services import services_of
from shared.coded_text import Measure, coded

_MAX_TURNS = 4  # uploads whose bodies of 12 MB are in memory
_MAX_TURNS_PER_ACCOUNT = 2  # one is read while another is decoded
TURN_S = 15.0  # 12 MB over a radio link of 6.4 Mbit/s


class UploadTurn:
    """Turn of one upload, in which its body is read and processed."""

    def __init__(self, account: str) -> None:
        self.account = account
        self.begun_s = asyncio.get_running_loop().time()
        self.is_reading = True  # its body has not come whole yet
        self.has_ended = False
        self._timeout: asyncio.Timeout | None = None

    async def receive(self, receive: Receive) -> Message:
        """Return the next part of the body.  Problem 408 once the turn has ended."""
        try:
            async with asyncio.timeout(0.0 if self.has_ended else None) as self._timeout:
                message = await receive()
        except TimeoutError:
            raise _too_slow() from None
        finally:
            self._timeout = None
        self.is_reading = bool(message.get("more_body"))
        return message

    def end(self) -> None:
        """End the turn; no more of the body is read."""
        self.has_ended = True
        if self._timeout is not None:
            self._timeout.reschedule(asyncio.get_running_loop().time())


class UploadTurns:
    """Turns of all uploads.  To be used in the event loop's thread only."""

    def __init__(self, turn_s: float = TURN_S) -> None:
        self._turn_s = turn_s
        self._turns: list[UploadTurn] = []  # oldest first
        self._waiting: dict[str, deque[asyncio.Future[UploadTurn]]] = {}  # next account first
        self._check: asyncio.TimerHandle | None = None

    @asynccontextmanager
    async def take(self, account: str) -> AsyncIterator[UploadTurn]:
        granted: asyncio.Future[UploadTurn] = asyncio.get_running_loop().create_future()
        self._waiting.setdefault(account, deque()).append(granted)
        try:
            self._grant()
            yield await granted
        finally:
            if granted.done() and not granted.cancelled():
                self._turns.remove(granted.result())
            self._grant()

    def _grant(self) -> None:
        """Give out the free turns; if a body waits for one, end slow ones."""
        account = self._next_account()
        while account is not None and len(self._turns) < _MAX_TURNS:
            queue = self._waiting.pop(account)
            granted = queue.popleft()
            self._waiting[account] = queue  # behind the others
            if not granted.done():  # the client may have gone
                turn = UploadTurn(account)
                self._turns.append(turn)
                granted.set_result(turn)
            account = self._next_account()
        if self._check is not None:
            self._check.cancel()
            self._check = None
        if account is not None:
            self._end_slow()

    def _next_account(self) -> str | None:
        """Account that has waited longest among those that may have another turn."""
        self._waiting = {account: queue for account, queue in self._waiting.items() if queue}
        held = Counter(turn.account for turn in self._turns)
        may = (one for one in self._waiting if held[one] < _MAX_TURNS_PER_ACCOUNT)
        return next(may, None)

    def _end_slow(self) -> None:
        """End the oldest turn whose body is still being received, once its time is over."""
        oldest = next((turn for turn in self._turns if turn.is_reading), None)
        if oldest is None or any(turn.has_ended for turn in self._turns):
            return
        loop, ends_s = asyncio.get_running_loop(), oldest.begun_s + self._turn_s
        if ends_s <= loop.time():
            oldest.end()
        else:
            self._check = loop.call_at(ends_s, self._grant)


class UploadRoute(APIRoute):
    """Route of a router with large bodies; those of logged-in users are read in turn."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def handle_in_turn(request: Request) -> Response:
            principal = await run_in_threadpool(principal_of, request, services_of(request))
            if principal is None:
                raise unauthenticated()
            if self.max_body_size != MAX_UPLOAD_BYTES:
                return await handle(request)
            turns: UploadTurns = request.app.state.upload_turns
            async with turns.take(principal.username) as turn:

                async def receive() -> Message:
                    return await turn.receive(request.receive)

                return await handle(Request(request.scope, receive))

        return handle_in_turn


def _too_slow() -> Problem:
    return Problem(
        408,
        coded(
            "upload-too-slow",
            "This took longer than {longest_s} to come, and others waited; make it smaller, or "
            "send it again over a better connection.",
            longest_s=Measure(TURN_S, f"{TURN_S:.0f} s"),
        ),
        {"Connection": "close"},
    )
