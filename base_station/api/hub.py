"""Broadcasts live snapshots and deltas to the connected consoles.

Each message is encoded once and the same bytes go to all.  A client that cannot keep up
loses its queue, not the station its memory: once it takes something again it gets a snapshot.  One
that confirms what it has shown (``PacedClient``) gets what it missed as one message instead.
Trails, nearly all of a picture, go out when nothing else does: over a slow link too a console
shows at once where everybody is, and stays up to date.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future

import msgspec

from base_station.api.hub_client import Client, PacedClient
from base_station.api.position_ages import PositionAges
from base_station.engine.ports import LiveSource, Trails
from base_station.views.changes import UnitChanges
from base_station.views.wire import Delta, HealthView, Snapshot, Trail
from shared.errors import StoreError


class Hub:
    """A ``base_station.engine.ports.LiveSink`` with any number of clients."""

    def __init__(self) -> None:
        self._encoder = msgspec.json.Encoder()
        self._changes = UnitChanges()  # of the source's thread
        self._clients: set[Client] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._source: LiveSource | None = None
        self._requested = False
        # True if clients of the kind are connected; read in the source's thread: else none encodes.
        self._has_plain = self._has_paced = False
        self.health: HealthView | None = None  # as last published
        self.position_ages = PositionAges()

    def connect(self, loop: asyncio.AbstractEventLoop, source: LiveSource) -> None:
        """Connect the hub with the source of its messages; clients may join before that."""
        self._loop, self._source = loop, source
        if self._clients:
            self.request_snapshot()

    # ---- from any thread but the source's

    def snapshot(self) -> Future[Snapshot]:
        """Future of the present picture without trails; it is never done if the source has
        stopped.
        """
        future: Future[Snapshot] = Future()
        if self._source is not None:
            self._source.request_snapshot(lambda snapshot, _: future.set_result(snapshot))
        return future

    def picture(self) -> Future[tuple[Snapshot, Trails]]:
        """Future of the present picture with the trails of all units; it is never done if the
        source has stopped.
        """
        future: Future[tuple[Snapshot, Trails]] = Future()
        if self._source is not None:
            self._source.request_snapshot(lambda *picture: future.set_result(picture))
        return future

    # ---- in the source's thread

    def delta(self, delta: Delta) -> None:
        if delta.health is not None:
            self.health = delta.health
        self.position_ages.observe(delta)
        if self._has_plain or self._has_paced:
            whole = self._encoder.encode(delta) if self._has_plain else b""
            changes = self._encoder.encode(self._changes.of(delta)) if self._has_paced else b""
            self.broadcast_delta(whole, changes, tuple(delta.trails))

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self.health = snapshot.health
        self._changes.note_snapshot(snapshot)
        if self._has_plain or self._has_paced:
            self.broadcast_reset(self._encoder.encode(snapshot), trails)

    def broadcast_delta(self, whole: bytes, changes: bytes, redrawn: tuple[str, ...]) -> None:
        """Send a delta that is already encoded, as ``Delta`` and as ``FieldDelta``. ``redrawn``:
        units whose whole trail it contains.
        """
        if self._has_plain or self._has_paced:
            self._in_loop(self._broadcast_delta, whole, changes, redrawn)

    def broadcast_reset(self, message: bytes, trails: Trails) -> None:
        """Send an already encoded snapshot to all clients."""
        if self._has_plain or self._has_paced:
            self._in_loop(self._broadcast_snapshot, message, trails, False)

    def _deliver(self, snapshot: Snapshot, trails: Trails) -> None:
        self.health = snapshot.health
        self._changes.note_snapshot(snapshot)
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
        """Add a client that gets whole units.  Raises StoreError if there is no picture now."""
        client = Client(self.request_snapshot)
        self._add(client)
        return client

    def join_paced(self) -> PacedClient:
        """Add a client that gets changed fields.  Raises StoreError if there is no picture now."""
        client = PacedClient(self.request_snapshot)
        self._add(client)
        return client

    def leave(self, client: Client) -> None:
        self._clients.discard(client)
        self._note_kinds()

    def _add(self, client: Client) -> None:
        self._clients.add(client)
        self._note_kinds()
        try:
            client.request_snapshot()
        except StoreError:
            self.leave(client)
            raise

    def _note_kinds(self) -> None:
        self._has_paced = any(isinstance(one, PacedClient) for one in self._clients)
        self._has_plain = any(not isinstance(one, PacedClient) for one in self._clients)

    def request_snapshot(self) -> None:
        """Ask the source for a snapshot; clients that ask at the same time share one."""
        if self._source is not None and not self._requested:
            self._source.request_snapshot(self._deliver)  # if that fails, the next one asks again
            self._requested = True

    def _broadcast_delta(self, whole: bytes, changes: bytes, redrawn: tuple[str, ...]) -> None:
        """Queue a delta for all clients; one that joined after it was encoded waits for its
        snapshot.
        """
        for client in self._clients:
            client.enqueue_delta(changes if isinstance(client, PacedClient) else whole, redrawn)

    def _broadcast_snapshot(self, message: bytes, trails: Trails, requested_only: bool) -> None:
        if requested_only:
            self._requested = False
        encoded = {
            unit_id: msgspec.json.encode(Trail(unit_id, points))
            for unit_id, points in trails.items()
        }
        for client in self._clients:
            client.enqueue_snapshot(message, encoded, requested_only=requested_only)
