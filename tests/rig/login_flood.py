"""Floods of the console's address by strangers, from loopback addresses of their own: log-ins that
guess, and bodies that hardly come.  Bounded in number, rate and time.
"""

from __future__ import annotations

import asyncio
import json
from collections import Counter
from collections.abc import Callable, Coroutine
from contextlib import suppress
from threading import Thread
from typing import Self

_HEAD = (
    "POST /api/v1/login HTTP/1.1\r\nHost: station\r\nContent-Type: application/json\r\n"
    "Content-Length: {length}\r\n\r\n"
)
_ANSWERED_WITHIN_S = 30.0
Flood = Callable[["LoginFlood", int], Coroutine[None, None, None]]  # of one place, by its number


class LoginFlood:
    """One kind of flood, in a thread of its own while it is entered."""

    def __init__(self, port: int, flood: Flood, *, places: int, longest_s: float = 60.0) -> None:
        self.statuses: Counter[str] = Counter()
        self.port = port
        self._flood = flood
        self._places = places
        self._longest_s = longest_s
        self._thread = Thread(target=lambda: asyncio.run(self._run()), daemon=True)
        self._ended = False

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended = True
        self._thread.join()

    async def connect(self, place: int) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        address = f"127.{1 + place // 250}.0.{1 + place % 250}"
        return await asyncio.open_connection("127.0.0.1", self.port, local_addr=(address, 0))

    async def _run(self) -> None:
        end_s = asyncio.get_running_loop().time() + self._longest_s
        tasks = [asyncio.create_task(self._flood(self, place)) for place in range(self._places)]
        while not self._ended and asyncio.get_running_loop().time() < end_s:
            await asyncio.sleep(0.05)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def guesses(every_s: float, username: str = "") -> Flood:
    """Wrong passwords for one name, or for another name at every try."""

    async def guess(flood: LoginFlood, place: int) -> None:
        tried = 0
        while True:
            name = username or f"user {place} {tried}"
            with suppress(OSError, TimeoutError):
                flood.statuses[await _guess(flood, place, name)] += 1
            tried += 1
            await asyncio.sleep(every_s)

    return guess


async def _guess(flood: LoginFlood, place: int, username: str) -> str:
    """The status of the answer; empty: the connection was closed."""
    body = json.dumps({"username": username, "password": "a guess of many"}).encode()
    reader, writer = await flood.connect(place)
    try:
        writer.write(_HEAD.format(length=len(body)).encode() + body)
        async with asyncio.timeout(_ANSWERED_WITHIN_S):
            line = await reader.readline()
    finally:
        writer.close()
    return line.split()[1].decode() if line else ""


def slow_bodies(connections: int, every_s: float = 2.0) -> Flood:
    """So many connections of each place; one that is closed is opened again."""

    async def drip(flood: LoginFlood, place: int) -> None:
        await asyncio.gather(*(_drip(flood, place, every_s) for _ in range(connections)))

    return drip


async def _drip(flood: LoginFlood, place: int, every_s: float) -> None:
    while True:
        with suppress(OSError):
            reader, writer = await flood.connect(place)
            try:
                writer.write(_HEAD.format(length=1000).encode())
                while not reader.at_eof() and not writer.is_closing():
                    writer.write(b" ")
                    await asyncio.sleep(every_s)
            finally:
                writer.close()
        flood.statuses["closed"] += 1
        await asyncio.sleep(every_s)
