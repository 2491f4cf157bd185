"""Queue of messages for one console."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from base_station.views.changes import merged_messages

MAX_QUEUED = 128  # deltas a client may be behind, some six seconds
MAX_UNSHOWN = 1  # snapshots and deltas: the next one has all changes since
MAX_UNSHOWN_BYTES = 1 << 18  # trails go out while no more than that is not shown yet


class Client:
    """Console that gets every delta in order.  ``ask`` requests a snapshot from the source."""

    def __init__(self, ask: Callable[[], None]) -> None:
        self._ask = ask
        self._queue: deque[bytes] = deque()
        self._trails: dict[str, bytes] = {}  # by unit: behind the snapshot, and not yet sent
        self._is_changed = asyncio.Event()
        self._behind = False  # lost its queue and needs a snapshot
        self._waiting = False  # a snapshot is under way
        self.lapses = 0  # how often it was too slow

    async def next_message(self) -> bytes:
        """Wait for the next message in order, and return it."""
        while (message := self._take()) is None:
            self._is_changed.clear()
            if self._behind and self._is_ready:
                self.request_snapshot()
            await self._is_changed.wait()
        return message

    def request_snapshot(self) -> None:
        """Drop the queue; the next message will be a snapshot."""
        self._clear()
        self._behind = False
        if not self._waiting:
            self._waiting = True
            self._ask()

    def enqueue_delta(self, message: bytes, redrawn: Iterable[str]) -> None:
        """Queue a delta.  ``redrawn``: units whose whole trail it contains."""
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

    @property
    def _is_ready(self) -> bool:
        """True if a snapshot would be sent at once."""
        return True

    def _take(self) -> bytes | None:
        """Remove and return the messages that are sent next."""
        return self._queue.popleft() if self._queue else self._take_trail()

    def _take_trail(self) -> bytes | None:
        return self._trails.pop(next(iter(self._trails))) if self._trails else None

    def _clear(self) -> None:
        self._queue.clear()
        self._trails.clear()

    def _enqueue(self, message: bytes) -> None:
        self._queue.append(message)
        self._is_changed.set()


class _Sent(NamedTuple):
    number: int  # of the message over this connection, from 1
    is_picture: bool  # a snapshot or a delta
    size: int


class PacedClient(Client):
    """Console that gets ``FieldDelta``, at the rate at which it shows them.  Changes that come
    meanwhile are merged, so that a slow console shows the newest state and skips earlier ones.
    """

    def __init__(self, ask: Callable[[], None]) -> None:
        super().__init__(ask)
        self._unshown: deque[_Sent] = deque()
        self._sent_count = 0
        self._is_trail_next = False
        self._begins_with_snapshot = False  # the queue

    def note_shown(self, count: int) -> None:
        """Note how many messages of this connection the console has shown."""
        while self._unshown and self._unshown[0].number <= count:
            self._unshown.popleft()
        self._is_changed.set()

    def request_snapshot(self) -> None:
        super().request_snapshot()
        self._unshown.clear()  # in any case it takes a snapshot now

    def enqueue_snapshot(
        self, message: bytes, trails: Mapping[str, bytes], *, requested_only: bool
    ) -> None:
        if self._waiting or not requested_only:
            self._begins_with_snapshot = True
        super().enqueue_snapshot(message, trails, requested_only=requested_only)

    @property
    def _is_ready(self) -> bool:
        return sum(one.is_picture for one in self._unshown) < MAX_UNSHOWN

    def _take(self) -> bytes | None:
        """Remove and return what is sent next: pictures and trails in turn, so that a slow console
        gets both.
        """
        has_room = sum(one.size for one in self._unshown) < MAX_UNSHOWN_BYTES
        is_trail = bool(self._trails) and has_room and (self._is_trail_next or not self._queue)
        if is_trail and not self._begins_with_snapshot:
            return self._note(self._take_trail(), is_picture=False)
        if self._queue and self._is_ready:
            return self._note(self._take_picture(), is_picture=True)
        return None

    def _take_picture(self) -> bytes:
        if self._begins_with_snapshot or len(self._queue) == 1:
            self._begins_with_snapshot = False
            return self._queue.popleft()
        waiting = tuple(self._queue)
        self._queue.clear()
        return merged_messages(waiting)

    def _note(self, message: bytes | None, *, is_picture: bool) -> bytes | None:
        if message is not None:
            self._sent_count += 1
            self._is_trail_next = is_picture
            self._unshown.append(_Sent(self._sent_count, is_picture, len(message)))
        return message
