"""Connections to a bus by somebody who has no certificate, many at once: a program of its own.

python -m tests.rig.connection_flood KIND HOST PORT SECONDS HELD PER_SECOND SOURCES

``HELD`` connections are opened first and stay open, ``PER_SECOND`` more follow from each of
``SOURCES`` addresses of the loopback.  It ends by itself, after ten minutes at most.
"""

from __future__ import annotations

import asyncio
import socket
import ssl
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from subprocess import PIPE, Popen

from base_station.process.open_files import allow_many_files

_MOST_SECONDS = 600.0
_MOST_HELD, _MOST_PER_S, _MOST_SOURCES = 4000, 1000, 250
_TURN_S = 0.02
_BEGUN = "flood begun"
_CONNECT_S = 3.0


def _client_hello() -> bytes:
    """The first message of a handshake, as anybody can make it."""
    incoming, outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
    greeting = ssl.create_default_context().wrap_bio(incoming, outgoing, server_hostname="station")
    with suppress(ssl.SSLWantReadError):
        greeting.do_handshake()
    return outgoing.read()


KINDS: dict[str, Callable[[], bytes | None]] = {
    "silent": lambda: b"",
    "closed": lambda: None,  # opened and closed at once
    "garbage": lambda: b"GET / HTTP/1.1\r\n\r\n",
    "hello": _client_hello,  # and then nothing
}


class Flood:
    """Opens connections to one place; keeps them open, but for those that are ``closed``."""

    def __init__(self, kind: str, host: str, port: int) -> None:
        self._says = KINDS[kind]()
        self._place = host, port
        self._open: list[socket.socket] = []
        self._tasks: set[asyncio.Task[None]] = set()

    async def run(self, seconds: float, held: int, per_s: float, sources: int) -> None:
        loop = asyncio.get_running_loop()
        for number in range(held):
            self._begin(loop, number % sources)
            if number % 50 == 0:
                await asyncio.sleep(_TURN_S)
        print(_BEGUN, flush=True)
        begun_s, sent = loop.time(), 0
        while (ran_s := loop.time() - begun_s) < seconds:
            while sent < ran_s * per_s * sources:
                self._begin(loop, sent % sources)
                sent += 1
            await asyncio.sleep(_TURN_S)

    def _begin(self, loop: asyncio.AbstractEventLoop, source: int) -> None:
        task = loop.create_task(self._connect(loop, source))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _connect(self, loop: asyncio.AbstractEventLoop, source: int) -> None:
        connection = socket.socket()
        connection.setblocking(False)
        try:
            if self._place[0].startswith("127."):
                connection.bind((f"127.0.{1 + source // 250}.{1 + source % 250}", 0))
            async with asyncio.timeout(_CONNECT_S):
                await loop.sock_connect(connection, self._place)
                if self._says:
                    await loop.sock_sendall(connection, self._says)
        except OSError:
            connection.close()
            return
        if self._says is None:
            connection.close()
        else:
            self._open.append(connection)


@contextmanager
def connection_flood(
    kind: str,
    host: str,
    port: int,
    seconds: float,
    *,
    held: int,
    per_s: float,
    sources: int = 1,
    inside: Sequence[str] = (),
) -> Iterator[None]:
    """From when the held ones are open; ends it at the latest after ``seconds``.

    ``inside``: what to put before the command so that it runs in another network.
    """
    arguments = (kind, host, port, seconds, held, per_s, sources)
    command = [*inside, sys.executable, "-m", __spec__.name, *map(str, arguments)]
    with Popen(command, stdout=PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline().strip() == _BEGUN
            yield
        finally:
            process.kill()


def main(kind: str, host: str, port: str, *amounts: str) -> None:
    seconds, held, per_s, sources = map(float, amounts)
    allow_many_files()
    asyncio.run(
        Flood(kind, host, int(port)).run(
            min(seconds, _MOST_SECONDS),
            min(int(held), _MOST_HELD),
            min(per_s, _MOST_PER_S),
            min(int(sources), _MOST_SOURCES),
        )
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
