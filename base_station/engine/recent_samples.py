"""Newest posted samples of a unit.  Its tracking agent asks for those that the link to it has lost,
as it asks the journal of a unit on the bus.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterator
from threading import Lock

from shared.channels import IMU
from shared.messages import JournalChunk, JournalEntry

_KEPT_BYTES = 2_000_000  # some ten minutes of six axes at 100 Hz
_MOST_REPLY_BYTES = 65_536

_log = logging.getLogger(__name__)


class RecentSamples:
    """Ring of messages.  Thread-safe."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._kept: deque[tuple[int, int, bytes]] = deque()  # boot, sequence number, payload
        self._kept_bytes = 0

    def add(self, boot_id: int, seq: int, payload: bytes) -> None:
        """Add a message; the oldest ones are dropped to make room."""
        with self._lock:
            self._kept.append((boot_id, seq, payload))
            self._kept_bytes += len(payload)
            while self._kept_bytes > _KEPT_BYTES:
                self._kept_bytes -= len(self._kept.popleft()[2])

    def replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        """Answer a query in the form of ``edge.storage.journal.server``; without a reply if it is
        not valid.
        """
        del payload
        values = dict(pair.split("=", 1) for pair in parameters.split(";") if "=" in pair)
        try:
            boot_id, first, last = (int(values[name]) for name in ("epoch", "from", "to"))
            max_bytes = min(int(values.get("total", _MOST_REPLY_BYTES)), _MOST_REPLY_BYTES)
        except (KeyError, ValueError):
            _log.warning("a question for %s makes no sense: %r", key, parameters)
            return
        with self._lock:
            found = {seq: one for boot, seq, one in self._kept if boot == boot_id}
        if not found:
            return  # of another program under this name, or long gone
        entries: list[JournalEntry] = []
        for seq in sorted(seq for seq in found if first <= seq <= last):
            entries.append(JournalEntry(seq, IMU.suffix, found[seq]))
            max_bytes -= len(found[seq])
            if max_bytes <= 0:
                last = seq
                break
        yield JournalChunk(boot_id, first, last, tuple(entries), raw_only=True).to_bytes()
