"""Times of samples on this machine's clock, from when pieces of the audio came.

A piece comes after its last sample, some time later than that and never before.  So the least delay
of the last seconds is the best estimate.  A device whose clock runs fast or slow, and a stream that
stands still and catches up, are followed by that alone.
"""

from __future__ import annotations

from collections import deque

from shared.clock import NS_PER_S


class SampleClock:
    def __init__(self, window_s: float) -> None:
        """``window_s``: of audio over which the least delay is taken."""
        self._window_s = window_s
        self._least: deque[tuple[float, int]] = deque()  # rising delays, the least first

    def note(self, end_s: float, received_ns: int) -> None:
        """A piece that ends at ``end_s`` of the source's own time was there at ``received_ns``,
        monotonic.
        """
        offset_ns = received_ns - round(end_s * NS_PER_S)
        while self._least and self._least[-1][1] >= offset_ns:
            self._least.pop()
        self._least.append((end_s, offset_ns))
        while self._least[0][0] < end_s - self._window_s:
            self._least.popleft()

    def time_ns(self, at_s: float) -> int:
        """Monotonic time of a sample, given in the source's own time; note a piece before."""
        return self._least[0][1] + round(at_s * NS_PER_S)

    def restart(self) -> None:
        """The source's own time begins anew."""
        self._least.clear()
