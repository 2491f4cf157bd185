"""Listener to the raw stream of another unit on the bus, for the agent that tracks for it.

One thread takes; a thread of the bus puts in.  What comes faster than it is taken is dropped,
newest first, and counted: the tracker sees a hole in time and says so.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from threading import Condition, Event

from edge.sample_codec.descriptions import sensors_of
from edge.samples import SensorDescription
from shared.bus import Bus
from shared.channels import DESCRIPTION, IMU, NO_TRACKER, raw_journal_key
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.codec import decode
from shared.errors import BusError, WireError
from shared.messages import JournalChunk, RawImu, UnitDescription

logger = logging.getLogger(__name__)

_QUEUE_MAX = 4096  # messages: some minutes
_RETRY_S = 1.0
_POLL_S = 0.1
_FETCH_BYTES = 32_768  # a question; at 100 kbit/s it takes three seconds
_FETCH_TIMEOUT_S = 5.0
_FETCH_LIMIT_NS = 15 * NS_PER_S  # in all: the wearer's place is not known meanwhile
_SILENT_NS = 5 * NS_PER_S  # the newest run, when one before it may speak again
_BOOTS_KEPT = 8


class RawStreamListener:
    """Listener; ``open`` it once; ``take`` gives the messages in the order in which they came."""

    def __init__(
        self, unit_id: str, open_bus: Callable[[], Bus], clock: Clock | None = None
    ) -> None:
        self.unit_id = unit_id
        self._open_bus = open_bus
        self._clock = clock or SystemClock()
        self._changed = Condition()
        self._waiting: deque[RawImu] = deque()
        self._descriptions: dict[int, UnitDescription] = {}  # by boot; the newest few
        self._current_boot: int | None = None  # the boot that is received
        self._last_received_ns = 0  # when it was, last
        self._ended_boots: deque[int] = deque(
            maxlen=_BOOTS_KEPT
        )  # boots that another one has followed
        self._declared = ExitStack()
        self._bus: Bus | None = None
        self.dropped = 0  # messages: too fast, of no known sensor, or of a run that is over
        self.not_understood = 0

    def open(self, stop: Event) -> bool:
        """Open the bus, trying until it works; return False when stopped before."""
        is_reported = False
        while not stop.is_set():
            try:
                bus = self._open_bus()
            except BusError as error:
                if not is_reported:
                    logger.warning("%s; trying again every second", error)
                is_reported = True
                stop.wait(_RETRY_S)
                continue
            self._bus = bus
            self._declared.callback(bus.close)
            for channel, handler in ((DESCRIPTION, self._describe), (IMU, self._put)):
                self._declared.callback(bus.subscribe(channel.key(self.unit_id), handler).close)
            return True
        return False

    def close(self) -> None:
        self._declared.close()

    def next_boot(self, stop: Event) -> tuple[int, dict[str, SensorDescription]] | None:
        """Wait for samples of a boot of the unit whose sensors are known; None when stopped."""
        logger.info("waiting for the raw stream of %s", self.unit_id)
        while not stop.is_set():
            with self._changed:
                self._changed.wait_for(self._is_described, timeout=_POLL_S)
                if self._is_described():
                    boot_id = self._waiting[0].header.boot_id
                    return boot_id, sensors_of(self._descriptions[boot_id])
        return None

    def take(self, boot_id: int, timeout_s: float) -> RawImu | None:
        """Return the next message of this boot; None when there is none in time, or of another
        boot.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._waiting, timeout=timeout_s)
            if not self._waiting or self._waiting[0].header.boot_id != boot_id:
                return None
            return self._waiting.popleft()

    def fetch(self, boot_id: int, after_seq: int, before_seq: int) -> Iterator[RawImu]:
        """Yield the raw samples between two sequence numbers from the unit's journal, in order.

        It ends before the last one where the unit does not answer, has no more of them, or the
        time for it is over.
        """
        end_ns = self._clock.monotonic_ns() + _FETCH_LIMIT_NS
        first = after_seq + 1
        while first < before_seq and self._bus is not None and self._clock.monotonic_ns() < end_ns:
            parameters = f"epoch={boot_id};from={first};to={before_seq - 1};total={_FETCH_BYTES}"
            selector = f"{raw_journal_key(self.unit_id)}?{parameters}"
            queried_from = first
            for reply in self._bus.query(selector, b"", _FETCH_TIMEOUT_S):
                chunk = JournalChunk.from_bytes(reply)
                for entry in chunk.entries:
                    raw = decode(IMU, entry.payload)
                    assert isinstance(raw, RawImu)
                    yield raw
                first = chunk.to_seq + 1
            if first == queried_from:
                return

    def has_restarted(self, boot_id: int) -> bool:
        """Return True if what comes next is of another boot than this."""
        with self._changed:
            return bool(self._waiting) and self._waiting[0].header.boot_id != boot_id

    def _is_described(self) -> bool:
        return bool(self._waiting) and self._waiting[0].header.boot_id in self._descriptions

    def _describe(self, _: str, payload: bytes) -> None:
        try:
            description = decode(DESCRIPTION, payload)
        except WireError:
            self.not_understood += 1
            return
        assert isinstance(description, UnitDescription)
        if description.tracker != NO_TRACKER:
            logger.warning("%s tracks itself; nothing is tracked for it", self.unit_id)
            return
        with self._changed:
            self._descriptions[description.header.boot_id] = description
            for oldest in list(self._descriptions)[:-4]:
                del self._descriptions[oldest]
            self._changed.notify_all()

    def _put(self, _: str, payload: bytes) -> None:
        try:
            raw = decode(IMU, payload)
        except WireError:
            self.not_understood += 1
            return
        assert isinstance(raw, RawImu)
        with self._changed:
            if not self._accepts(raw.header.boot_id) or len(self._waiting) >= _QUEUE_MAX:
                self.dropped += 1
                return
            self._waiting.append(raw)
            self._changed.notify_all()

    def _accepts(self, boot_id: int) -> bool:
        """A run that another one has followed is over: each word of it would begin the path anew,
        and the next one of the new run again.  Unless that one has fallen silent: then they were
        two machines under one name, and this one is left.
        """
        now_ns = self._clock.monotonic_ns()
        if boot_id != self._current_boot:
            if boot_id in self._ended_boots and now_ns - self._last_received_ns < _SILENT_NS:
                return False
            if self._current_boot is not None:
                self._ended_boots.append(self._current_boot)
                self._leave_out_undescribed()
            self._current_boot = boot_id
        self._last_received_ns = now_ns
        return True

    def _leave_out_undescribed(self) -> None:
        """Drop messages of boots that are over and have not described their sensor."""
        described = [one for one in self._waiting if one.header.boot_id in self._descriptions]
        self.dropped += len(self._waiting) - len(described)
        self._waiting = deque(described)
