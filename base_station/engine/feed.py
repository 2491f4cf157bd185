"""Live feed: the ordered queue of records from the bus to the engine.

A record is ``(t_ns, key, payload)`` with station time; ``base_station.core.events.event_of``
decodes it to an event.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from threading import Condition

from shared.channels import Qos, parse_key
from shared.clock import NS_PER_S, Clock
from shared.errors import UnknownChannelError
from shared.mcap_log import LogRecord

_GATHER_S = 0.004  # for more messages: waking a thread for each one costs too much
_OVERFLOW_REPORTED_NS = 60 * NS_PER_S
_RECORDS_MAX = 100_000
_BYTES_MAX = 64 * 1024 * 1024
_LATE_WAITING = 1024  # records that can wait, at most; their source waits meanwhile
_LATE_BYTES = 1024 * 1024
_LATE_AT_ONCE = 32  # of these behind live ones: some 3 ms of the pipeline's time


class LiveFeed:
    """Queue from the bus to the one thread that steps the pipeline.

    Any number of threads call ``offer`` and ``deliver``; one thread at a time calls ``take``. Data
    that can wait has a queue of its own, and comes in small portions behind live data.  Live data
    gets its station time when it enters, other data when it leaves; so the time never goes back in
    the order in which records come out.  Both queues are bounded: live data beyond the bound is
    dropped and counted in ``overflowed``; alerts are dropped only at twice the bound.
    """

    def __init__(
        self, clock: Clock, records_max: int = _RECORDS_MAX, bytes_max: int = _BYTES_MAX
    ) -> None:
        """``clock`` gives station time: its UTC must not go back (``SteadyClock``)."""
        self._clock = clock
        self._records_max = records_max
        self._bytes_max = bytes_max
        self._changed = Condition()
        self._queue: list[LogRecord] = []
        self._bytes = 0
        self._late: deque[tuple[str, bytes]] = deque()
        self._late_bytes = 0
        self._late_pending = False  # of delivered records
        self._all_taken = False  # and the engine has not taken again since
        self._woken = False
        self._closed = False
        self._overflowed_ns = 0
        self.overflowed = 0  # messages that came faster than they were taken, and were dropped

    @property
    def overflows(self) -> bool:
        """True if messages were dropped within the last minute."""
        since_ns = self._clock.monotonic_ns() - self._overflowed_ns
        return self.overflowed > 0 and since_ns < _OVERFLOW_REPORTED_NS

    @property
    def late_waits(self) -> bool:
        """True if delivered records may not be in the log yet: they wait here, or the engine has
        taken them and not called ``take`` again.
        """
        return self._late_pending

    @property
    def follows(self) -> bool:
        """False: records come from the bus."""
        return False

    def offer(self, key: str, payload: bytes) -> None:
        """Callback for a bus: give the message its station time, queue it, and return at once."""
        with self._changed:
            if self._has_room(1.0) or (_is_alert(key) and self._has_room(2.0)):
                self._append(key, payload)
            else:
                self.overflowed += 1
                self._overflowed_ns = self._clock.monotonic_ns()

    def deliver(self, key: str, payload: bytes) -> None:
        """Queue a message that can wait, and return when few of these wait.  An alert is queued
        with live data.
        """
        with self._changed:
            if not self._has_late_room(1.0):  # then it waits for more room than for one record
                self._changed.wait_for(lambda: self._has_late_room(0.5) or self._closed)
            self._late_pending, self._all_taken = True, False
            if _is_alert(key):
                self._append(key, payload)
                return
            self._late.append((key, payload))
            self._late_bytes += len(payload)
            if len(self._late) == 1:
                self._changed.notify_all()

    def take(self, timeout_s: float) -> list[LogRecord]:
        """Return all live records in order, and some of those that can wait.  Waits for a record,
        for ``wake`` or for the timeout.
        """
        with self._changed:
            self._late_pending = self._late_pending and not self._all_taken
            self._changed.wait_for(lambda: self._queue or self._late or self._woken, timeout_s)
            if self._queue and not self._late:  # records in quick succession are taken together
                self._changed.wait_for(lambda: self._woken, min(_GATHER_S, timeout_s))
            self._woken = False
            records, self._queue = self._queue, []
            self._bytes = 0
            had_room = self._has_late_room(0.5)
            records += self._take_late()
            if not had_room and self._has_late_room(0.5):
                self._changed.notify_all()
            self._all_taken = not self._late
            return records

    def wake(self) -> None:
        """End the wait of ``take``. Thread-safe."""
        with self._changed:
            self._woken = True
            self._changed.notify_all()

    def close(self) -> None:
        """Release all callers of ``deliver``, as nothing will be taken any more."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _has_room(self, share: float) -> bool:
        return (
            len(self._queue) < share * self._records_max and self._bytes < share * self._bytes_max
        )

    def _has_late_room(self, share: float) -> bool:
        return len(self._late) < share * _LATE_WAITING and self._late_bytes < share * _LATE_BYTES

    def _take_late(self) -> Iterator[LogRecord]:
        for _ in range(min(len(self._late), _LATE_AT_ONCE)):
            key, payload = self._late.popleft()
            self._late_bytes -= len(payload)
            yield self._clock.utc_ns(), key, payload

    def _append(self, key: str, payload: bytes) -> None:
        self._queue.append((self._clock.utc_ns(), key, payload))
        self._bytes += len(payload)
        if len(self._queue) == 1:
            self._changed.notify_all()


def _is_alert(key: str) -> bool:
    try:
        return parse_key(key)[1].qos is Qos.ALERT
    except UnknownChannelError:
        return False
