"""Broadcasts live snapshots and deltas to the consoles that watch.

A delta is encoded once and the same bytes go to everyone.  A client that cannot keep up loses
its queue, not the station its memory: once it takes something again it gets a snapshot.  Trails,
nearly all of a picture, go out when nothing else does: over a slow link too a console shows at
once where everybody is, and stays up to date.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future

import msgspec

from base_station.api.position_ages import PositionAges
from base_station.engine.ports import LiveSource, Trails
from base_station.views.wire import Delta, HealthView, Snapshot, Trail
from shared.errors import StoreError

MAX_QUEUED = 64  # messages a client may be behind, some three seconds


class Client:
    """One console's place in the hub."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self._queue: deque[bytes] = deque()
        self._trails: dict[str, bytes] = {}  # by unit: behind the snapshot, and not yet sent
        self._has_message = asyncio.Event()
        self._behind = False  # lost its queue and needs a snapshot
        self._waiting = False  # a snapshot is under way
        self.lapses = 0  # how often it was too slow

    async def next_message(self) -> bytes:
        """The next message in order, waiting for it."""
        while not (self._queue or self._trails):
            self._has_message.clear()
            if self._behind:
                self.request_snapshot()
            await self._has_message.wait()
        return self._queue.popleft() if self._queue else self._trails.pop(next(iter(self._trails)))

    def request_snapshot(self) -> None:
        """Drops the queue; the next message will be a snapshot."""
        self._clear()
        self._behind = False
        if not self._waiting:
            self._waiting = True
            self._hub.request_snapshot()

    def enqueue_delta(self, message: bytes, redrawn: Iterable[str]) -> None:
        """``redrawn``: the units whose whole trail it has."""
        if self._waiting or self._behind:
            return
        if len(self._queue) >= MAX_QUEUED:
            self._clear()
            self._behind = True
            self.lapses += 1
            return
        for unit_id in redrawn:
            self._trails.pop(unit_id, None)
        self._enqueue(message)

    def enqueue_snapshot(
        self, message: bytes, trails: Mapping[str, bytes], *, requested_only: bool
    ) -> None:
        if requested_only and not self._waiting:
            return
        self._waiting = self._behind = False
        self._clear()
        self._trails.update(trails)
        self._enqueue(message)

    def _clear(self) -> None:
        self._queue.clear()
        self._trails.clear()

    def _enqueue(self, message: bytes) -> None:
        self._queue.append(message)
        self._has_message.set()


class Hub:
    """A ``base_station.engine.ports.LiveSink`` with any number of clients."""

    def __init__(self) -> None:
        self._encoder = msgspec.json.Encoder()
        self._clients: set[Client] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._source: LiveSource | None = None
        self._requested = False
        self._watched = False  # read in the source's thread: without clients nothing is encoded
        self.health: HealthView | None = None  # as last said
        self.position_ages = PositionAges()

    def connect(self, loop: asyncio.AbstractEventLoop, source: LiveSource) -> None:
        """Connects the hub with its source; clients may join before."""
        self._loop, self._source = loop, source
        if self._clients:
            self.request_snapshot()

    # ---- from any thread but the source's

    def snapshot(self) -> Future[Snapshot]:
        """The picture as it is now, without trails; never done where the source has stopped."""
        future: Future[Snapshot] = Future()
        if self._source is not None:
            self._source.request_snapshot(lambda snapshot, _: future.set_result(snapshot))
        return future

    def picture(self) -> Future[tuple[Snapshot, Trails]]:
        """The same with the trails of all units."""
        future: Future[tuple[Snapshot, Trails]] = Future()
        if self._source is not None:
            self._source.request_snapshot(lambda *picture: future.set_result(picture))
        return future

    # ---- in the source's thread

    def delta(self, delta: Delta) -> None:
        if delta.health is not None:
            self.health = delta.health
        self.position_ages.observe(delta)
        if self._watched:
            self.broadcast_delta(self._encoder.encode(delta), tuple(delta.trails))

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self.health = snapshot.health
        if self._watched:
            self.broadcast_reset(self._encoder.encode(snapshot), trails)

    def broadcast_delta(self, message: bytes, redrawn: tuple[str, ...]) -> None:
        """A delta that is encoded already; ``redrawn``: the units whose whole trail it has."""
        if self._watched:
            self._in_loop(self._broadcast_delta, message, redrawn)

    def broadcast_reset(self, message: bytes, trails: Trails) -> None:
        """A snapshot that is encoded already, for everybody."""
        if self._watched:
            self._in_loop(self._broadcast_snapshot, message, trails, False)

    def _deliver(self, snapshot: Snapshot, trails: Trails) -> None:
        self.health = snapshot.health
        self._in_loop(self._broadcast_snapshot, self._encoder.encode(snapshot), trails, True)

    def _in_loop(self, function: Callable[..., None], *arguments: object) -> None:
        if self._loop is None:
            return
        try:
            self._loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # the loop has closed: the station is stopping
            self._loop = None

    # ---- in the loop

    @property
    def watchers(self) -> int:
        return len(self._clients)

    def join(self) -> Client:
        """Raises StoreError where there is no picture now."""
        client = Client(self)
        self._clients.add(client)
        self._watched = True
        try:
            client.request_snapshot()
        except StoreError:
            self.leave(client)
            raise
        return client

    def leave(self, client: Client) -> None:
        self._clients.discard(client)
        self._watched = bool(self._clients)

    def request_snapshot(self) -> None:
        """Many clients that ask at once share one snapshot."""
        if self._source is not None and not self._requested:
            self._source.request_snapshot(self._deliver)  # if that fails, the next one asks again
            self._requested = True

    def _broadcast_delta(self, message: bytes, redrawn: tuple[str, ...]) -> None:
        for client in self._clients:
            client.enqueue_delta(message, redrawn)

    def _broadcast_snapshot(self, message: bytes, trails: Trails, requested_only: bool) -> None:
        if requested_only:
            self._requested = False
        encoded = {
            unit_id: msgspec.json.encode(Trail(unit_id, points))
            for unit_id, points in trails.items()
        }
        for client in self._clients:
            client.enqueue_snapshot(message, encoded, requested_only=requested_only)
