"""Pace of deltas for consoles: as often as they can be followed, while that costs little."""

from __future__ import annotations

from shared.clock import NS_PER_S

SHORTEST_NS = NS_PER_S // 20
USUAL_NS = NS_PER_S // 10  # twice as often as units send positions
# Of the thread's time: a tenth while they come more often than usual, and never over a quarter.
OFTEN_SHARE = 10
MOST_SHARE = 4


def interval_ns(spent_ns: int) -> int:
    """Time until the next delta after one that took ``spent_ns`` of the thread's processor time."""
    return max(SHORTEST_NS, min(spent_ns * OFTEN_SHARE, USUAL_NS), spent_ns * MOST_SHARE)
