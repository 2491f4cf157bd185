"""Rate of deltas for consoles: as frequent as is useful, within a share of processor time."""

from __future__ import annotations

from shared.clock import NS_PER_S

SHORTEST_NS = NS_PER_S // 20
USUAL_NS = NS_PER_S // 10  # twice as often as units send positions
# Of the thread's time: a tenth while they come more often than usual, and never over a quarter.
OFTEN_SHARE = 10
MOST_SHARE = 4


class DeltaPace:
    """Due times of deltas, from the cost of the last one; by a monotonic clock."""

    def __init__(self, now_ns: int) -> None:
        self.due_ns = now_ns
        self.urgent_due_ns = now_ns  # with alarms or commands

    def send_at_once(self) -> None:
        self.due_ns = 0

    def note_sent(self, now_ns: int, spent_ns: int) -> None:
        """Note a sent delta.  ``spent_ns``: the thread's processor time for it."""
        often_ns = min(spent_ns * OFTEN_SHARE, USUAL_NS)
        interval_ns = max(SHORTEST_NS, often_ns, spent_ns * MOST_SHARE)
        late_ns = now_ns - self.due_ns
        # Counted from the due time: otherwise a busy machine would send fewer.
        from_ns = self.due_ns if 0 <= late_ns < interval_ns else now_ns
        self.due_ns = from_ns + interval_ns
        self.urgent_due_ns = now_ns + interval_ns // 2
