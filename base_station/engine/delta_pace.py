"""Pace of deltas for consoles: as often as they can be followed, while that costs little."""

from __future__ import annotations

from shared.clock import NS_PER_S

SHORTEST_NS = NS_PER_S // 20
USUAL_NS = NS_PER_S // 10  # twice as often as units send positions
# Of the thread's time: a tenth while they come more often than usual, and never over a quarter.
OFTEN_SHARE = 10
MOST_SHARE = 4
# Threads of a process take turns at the interpreter: above this, messages wait for the consoles'.
_BUSY_CORE_SHARE = 0.9
_MEASURED_OVER_NS = NS_PER_S


class DeltaPace:
    """Interval of deltas by what one costs, and by whether the process has a core's time left."""

    def __init__(self) -> None:
        self._since_ns: int | None = None
        self._process_ns = 0
        self._is_busy = False

    def interval_ns(self, now_ns: int, spent_ns: int, process_ns: int) -> int:
        """Time until the next delta after one at ``now_ns``, a monotonic clock.

        ``spent_ns``: what it took of the thread's processor time.  ``process_ns``: processor time
        of all threads so far.
        """
        self._measure(now_ns, process_ns)
        often_ns = USUAL_NS if self._is_busy else min(spent_ns * OFTEN_SHARE, USUAL_NS)
        return max(SHORTEST_NS, often_ns, spent_ns * MOST_SHARE)

    def _measure(self, now_ns: int, process_ns: int) -> None:
        if self._since_ns is None:
            self._since_ns, self._process_ns = now_ns, process_ns
        elapsed_ns = now_ns - self._since_ns
        if elapsed_ns >= _MEASURED_OVER_NS:
            self._is_busy = process_ns - self._process_ns > _BUSY_CORE_SHARE * elapsed_ns
            self._since_ns, self._process_ns = now_ns, process_ns
