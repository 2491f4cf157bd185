"""A complete segment that is elsewhere, read by ranges of its bytes."""

from __future__ import annotations

from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Callable, Sequence
from pathlib import Path
from threading import Lock

from shared.mcap_log.byte_ranges import SegmentRanges
from shared.mcap_log.segment_file import SegmentFile, behind_end

FetchRange = Callable[[int, int], bytes]  # bytes from an offset until before another one
_AHEAD_BYTES = 1 << 20  # read ahead, for the next chunks
_KEPT_BYTES = 64 << 20
_PREFETCHED_BYTES = 32 << 20  # at once; the rest is fetched when it is read


class RangedSegmentFile(SegmentFile):
    """Whole chunks are fetched and kept, several that stand beside each other by one request.

    What cannot be fetched is not damage: what ``fetch`` raises goes through.  Thread-safe.
    """

    def __init__(self, path: Path, ranges: SegmentRanges, fetch: FetchRange) -> None:
        """``path`` names it in messages alone."""
        self.path = path
        self.damage: list[str] = []
        self.is_given = True
        self.size = ranges.size
        self._ranges = ranges
        self._fetch = fetch
        bounds = {0, *(one.offset for one in ranges.chunks), ranges.summary_offset, ranges.size}
        self._bounds: Sequence[int] = sorted(bounds)
        self._blocks: OrderedDict[int, bytes] = OrderedDict()  # by number, the last used last
        self._lock = Lock()

    def close(self) -> None:
        """Keep fetched bytes for the next reader."""

    def prefetch(self, from_ns: int, until_ns: int) -> None:
        """Fetch the chunks that have records of the time at once; of a long time the first."""
        wanted = [
            self._block_at(one.offset)
            for one in self._ranges.chunks
            if one.until_ns >= from_ns and one.from_ns < until_ns
        ]
        if wanted:
            until = self._bounds[wanted[0]] + _PREFETCHED_BYTES
            last = max(wanted[0], min(wanted[-1], bisect_right(self._bounds, until) - 2))
            with self._lock:
                self._load(wanted[0], last, ahead_bytes=0)

    def read(self, offset: int, count: int) -> bytes:
        if offset + count > self.size:
            raise behind_end()
        if count == 0:
            return b""
        first, last = self._block_at(offset), self._block_at(offset + count - 1)
        with self._lock:
            self._load(first, last, _AHEAD_BYTES)
            data = b"".join(self._blocks[number] for number in range(first, last + 1))
            for number in range(first, last + 1):
                self._blocks.move_to_end(number)
        begin = offset - self._bounds[first]
        return data[begin : begin + count]

    def _block_at(self, offset: int) -> int:
        return bisect_right(self._bounds, offset) - 1

    def _load(self, first: int, last: int, ahead_bytes: int) -> None:
        """Fetch what is missing of these blocks, and of those behind them, by one request."""
        missing = [number for number in range(first, last + 1) if number not in self._blocks]
        if not missing:
            return
        first, last = missing[0], missing[-1]
        bounds = self._bounds
        while (
            last + 2 < len(bounds)
            and bounds[last + 2] - bounds[first] <= ahead_bytes
            and bounds[last + 1] < self._ranges.summary_offset
            and last + 1 not in self._blocks
        ):
            last += 1
        data = self._fetch(bounds[first], bounds[last + 1])
        for number in range(first, last + 1):
            begin, end = bounds[number] - bounds[first], bounds[number + 1] - bounds[first]
            self._blocks[number] = data[begin:end]
            self._blocks.move_to_end(number)
        self._forget(set(range(first, last + 1)))

    def _forget(self, needed: set[int]) -> None:
        """Drop the least recently used bytes where there are too many in all."""
        kept_bytes = sum(map(len, self._blocks.values()))
        for number in list(self._blocks):
            if kept_bytes <= _KEPT_BYTES:
                return
            if number not in needed:
                kept_bytes -= len(self._blocks.pop(number))
