"""Adaptive size of the chunks asked of a unit, so that an answer never fills a thin link.

Zenoh closes a link on which an answer waits for five seconds to be sent, and a queue of bulk data
lets the keep-alives miss the lease of three: asked for too much, a thin link goes down before it
has carried anything, again and again.  Its capacity is not known beforehand; so little is asked for
first, and more as long as answers come quickly that bring about as much.  An answer that brings
little is quick on any link.
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
        """The last answer brought so much, and took this long."""
        is_full = came_bytes >= _FULL_SHARE * self.answer_bytes
        most = 2 * self.answer_bytes if is_full else self.answer_bytes
        fitting = min(self.answer_bytes * _WANTED_NS // max(took_ns, 1), most)
        self.answer_bytes = max(LEAST_BYTES, min(fitting, MOST_BYTES))

    def note_timeout(self) -> None:
        """No answer came at all."""
        self.answer_bytes = LEAST_BYTES
