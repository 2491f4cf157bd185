"""Connections that are not authenticated yet: their number is bounded, networks take turns."""

from __future__ import annotations

import asyncio
from collections import deque


class PendingConnections:
    """Bounded set of connections: where there are too many, the oldest one of the network with the
    most connections is closed.

    A new connection is never refused.  So a unit that begins its handshake at once gets in, even
    where many silent connections come from its own address.
    """

    def __init__(self, max_count: int) -> None:
        self._max_count = max_count
        self._count = 0
        self._networks: dict[str, dict[asyncio.Task[None], None]] = {}  # oldest first

    def __len__(self) -> int:
        return self._count

    def add(self, network: str, task: asyncio.Task[None]) -> asyncio.Task[None] | None:
        """Add a connection; returns the one to close for it, if any."""
        self._networks.setdefault(network, {})[task] = None
        self._count += 1
        return self.oldest() if self._count > self._max_count else None

    def oldest(self) -> asyncio.Task[None] | None:
        """Remove and return the oldest connection of the network with the most connections."""
        if not self._networks:
            return None
        network = max(self._networks, key=lambda one: len(self._networks[one]))
        task = next(iter(self._networks[network]))
        self.remove(network, task)
        return task

    def remove(self, network: str, task: asyncio.Task[None]) -> None:
        """Remove a connection, if it is still counted."""
        tasks = self._networks.get(network, {})
        if task in tasks:
            del tasks[task]
            self._count -= 1
            if not tasks:
                del self._networks[network]


class RoundRobin:
    """Scheduler of expensive steps: one in each pass of the loop, so that links are served between
    them.  Networks take turns, so that many handshakes from one do not delay those from another.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._waiting: dict[str, deque[asyncio.Future[None]]] = {}  # in order of their turns
        self._scheduled = False

    async def wait(self, network: str) -> None:
        turn: asyncio.Future[None] = self._loop.create_future()
        self._waiting.setdefault(network, deque()).append(turn)
        self._schedule()
        await turn

    def _schedule(self) -> None:
        if self._waiting and not self._scheduled:
            self._scheduled = True
            self._loop.call_soon(self._release_next)

    def _release_next(self) -> None:
        self._scheduled = False
        while self._waiting:
            network = next(iter(self._waiting))
            turns = self._waiting.pop(network)
            turn = turns.popleft()
            if turns:
                self._waiting[network] = turns  # behind the others
            if not turn.done():
                turn.set_result(None)
                break
        self._schedule()
