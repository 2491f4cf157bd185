"""Feed of the engine of one of two stations: the other's log, and, once it leads, the bus."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from threading import Condition

from base_station.core.log_position import Record
from base_station.engine.feed import LiveFeed
from shared.channels import Direction, backfilled_key, is_backfilled, parse_key
from shared.clock import NS_PER_S, Clock
from shared.errors import UnknownChannelError

_FOLLOWED_BYTES = 16 * 1024 * 1024
_FOLLOWED_AT_ONCE = 500  # a long log to catch up with holds up neither consoles nor the end
_KEPT_NS = 30 * NS_PER_S  # of messages of the bus, for when the other station dies
_KEPT_BYTES = 16 * 1024 * 1024


class StandbyFeed:
    """A ``Feed``.  Any thread may ``offer`` and ``deliver``, one at a time may ``take``.

    A standby receives the bus too.  Its last messages are kept, and come when the standby leads,
    behind the fetched events: messages that the other station logged before it died are then left
    out by the drive, like all that came twice.
    """

    def __init__(self, live: LiveFeed, clock: Clock) -> None:
        self._live = live
        self._clock = clock
        self._changed = Condition()
        self._followed: deque[Record] = deque()
        self._followed_bytes = 0
        self._kept: deque[tuple[int, str, bytes]] = deque()  # monotonic time, key, payload
        self._kept_bytes = 0
        self.unit_received_ns = 0  # time of the last message of any unit; monotonic
        self._lead_requested = False
        self._woken = False
        self._closed = False
        self._follows = True

    @property
    def follows(self) -> bool:
        """Changes in ``take`` alone."""
        return self._follows

    @property
    def waiting(self) -> int:
        """Events of the other's log that are not taken yet."""
        return len(self._followed)

    def offer(self, key: str, payload: bytes) -> None:
        """Callback for the bus."""
        with self._changed:
            if self._follows:
                self._keep(key, payload)
                return
        self._live.offer(key, payload)

    def deliver(self, records: Sequence[Record]) -> None:
        """Events of the other's log; waits while there is too much."""
        with self._changed:
            self._changed.wait_for(lambda: self._followed_bytes < _FOLLOWED_BYTES or self._closed)
            self._followed += records
            self._followed_bytes += sum(len(payload) for _, _, payload in records)
            self._changed.notify_all()

    def lead(self) -> None:
        """Switch to the bus, after all records that were delivered before."""
        with self._changed:
            self._lead_requested = True
            self._changed.notify_all()

    def take(self, timeout_s: float) -> Sequence[Record]:
        with self._changed:
            if self._follows:
                self._changed.wait_for(
                    lambda: self._followed or self._woken or self._lead_requested, timeout_s
                )
                self._woken = False
                if self._followed or not self._lead_requested:
                    return self._take_followed()
                self._begin_live()
                timeout_s = 0.0
        return self._live.take(timeout_s)

    def wake(self) -> None:
        with self._changed:
            self._woken = True
            self._changed.notify_all()
        self._live.wake()

    def close(self) -> None:
        """No more is taken."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._live.close()

    def _take_followed(self) -> Sequence[Record]:
        count = min(len(self._followed), _FOLLOWED_AT_ONCE)
        records = [self._followed.popleft() for _ in range(count)]
        self._followed_bytes -= sum(len(payload) for _, _, payload in records)
        self._changed.notify_all()
        return records

    def _begin_live(self) -> None:
        self._follows = False
        for _, key, payload in self._kept:
            self._live.offer(key, payload)
        self._kept.clear()

    def _keep(self, key: str, payload: bytes) -> None:
        try:
            unit_id, channel = parse_key(key)
        except UnknownChannelError:
            return  # its unit still has the message in its journal
        if channel.direction is not Direction.UP or not channel.logged or is_backfilled(key):
            return
        now_ns = self.unit_received_ns = self._clock.monotonic_ns()
        self._kept.append((now_ns, backfilled_key(unit_id, channel.suffix), payload))
        self._kept_bytes += len(payload)
        while self._kept and (
            self._kept[0][0] < now_ns - _KEPT_NS or self._kept_bytes > _KEPT_BYTES
        ):
            self._kept_bytes -= len(self._kept.popleft()[2])
