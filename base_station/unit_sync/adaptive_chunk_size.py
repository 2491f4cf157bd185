"""Adaptive size of the chunks requested from a unit, so that a reply never fills a slow link.
Zenoh closes a link on which a reply waits for five seconds, and queued bulk data delays the
keep-alives beyond the lease of three seconds.  So too large a request would close a slow link again
and again.  Its capacity is unknown at first: the size starts small, and grows as long as replies of
about that size come quickly.  Small replies do not count, as they are quick on any link.
"""

from __future__ import annotations

from shared.clock import NS_PER_S

LEAST_BYTES, MOST_BYTES = 1024, 524_288  # the most is 10,000 messages a second
_WANTED_NS = NS_PER_S // 2  # of one answer
_FULL_SHARE = 0.25  # of the requested size: messages may be smaller than expected


class AdaptiveChunkSize:
    """Chunk size of one unit."""

    def __init__(self) -> None:
        self.answer_bytes = LEAST_BYTES

    def note(self, came_bytes: int, took_ns: int) -> None:
        """Note the bytes and the duration of the last reply."""
        is_full = came_bytes >= _FULL_SHARE * self.answer_bytes
        most = 2 * self.answer_bytes if is_full else self.answer_bytes
        fitting = min(self.answer_bytes * _WANTED_NS // max(took_ns, 1), most)
        self.answer_bytes = max(LEAST_BYTES, min(fitting, MOST_BYTES))

    def note_timeout(self) -> None:
        """Note that no reply came."""
        self.answer_bytes = LEAST_BYTES
