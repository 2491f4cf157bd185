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
    """Due times of deltas, by the cost of the last one and by whether the process has a core's
    time left.  Times are those of a monotonic clock.
    """

    def __init__(self, now_ns: int, process_ns: int) -> None:
        self.due_ns = now_ns
        self.urgent_due_ns = now_ns  # with alarms or commands
        self._since_ns, self._process_ns = now_ns, process_ns
        self._is_busy = False

    def send_at_once(self) -> None:
        self.due_ns = 0

    def note_sent(self, now_ns: int, spent_ns: int, process_ns: int) -> None:
        """``spent_ns``: what the delta took of the thread's processor time.  ``process_ns``:
        processor time of all threads so far.
        """
        self._measure(now_ns, process_ns)
        often_ns = USUAL_NS if self._is_busy else min(spent_ns * OFTEN_SHARE, USUAL_NS)
        interval_ns = max(SHORTEST_NS, often_ns, spent_ns * MOST_SHARE)
        late_ns = now_ns - self.due_ns
        # Counted from when it was due: a busy machine sends each late, and else sent fewer.
        from_ns = self.due_ns if 0 <= late_ns < interval_ns else now_ns
        self.due_ns = from_ns + interval_ns
        self.urgent_due_ns = now_ns + interval_ns // 2

    def _measure(self, now_ns: int, process_ns: int) -> None:
        elapsed_ns = now_ns - self._since_ns
        if elapsed_ns >= _MEASURED_OVER_NS:
            self._is_busy = process_ns - self._process_ns > _BUSY_CORE_SHARE * elapsed_ns
            self._since_ns, self._process_ns = now_ns, process_ns
