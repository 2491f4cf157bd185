"""Splits data of a TAK server into events; other data costs no memory."""

from __future__ import annotations

EVENT_BYTES_MAX = 65_536
_BEGIN, _END = b"<event", b"</event>"


class EventSplitter:
    """``push`` data as it comes; half an event waits for its other half."""

    def __init__(self) -> None:
        self._buffer = b""
        self.dropped_bytes = 0  # of data that was no event, or too long for one

    def push(self, data: bytes) -> list[bytes]:
        """Whole events, from their first tag to their last."""
        *ended, rest = (self._buffer + data).split(_END)
        events = []
        for one in ended:
            begin = one.rfind(_BEGIN)
            if begin < 0 or len(one) - begin > EVENT_BYTES_MAX:
                self.dropped_bytes += len(one)
                continue
            self.dropped_bytes += begin
            events.append(one[begin:] + _END)
        self._buffer = self._bounded(rest)
        return events

    def _bounded(self, rest: bytes) -> bytes:
        if len(rest) <= EVENT_BYTES_MAX:
            return rest
        self.dropped_bytes += len(rest)
        return b""
