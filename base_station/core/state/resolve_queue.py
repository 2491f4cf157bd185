"""Queue of units with pins whose journal brought late messages: their trails are solved again.  A
journal brings hundreds of messages.  So a trail is solved when they stop, or every few seconds
while they continue, for one unit a tick.
"""

from __future__ import annotations

import msgspec

from shared.clock import NS_PER_S

QUIET_NS = 2 * NS_PER_S  # nothing more has come for so long
MOST_NS = 10 * NS_PER_S  # waited for it


class PendingResolve(msgspec.Struct):
    """Station times at which the first and the last of it came."""

    first_ns: int
    last_ns: int

    def is_due(self, now_ns: int) -> bool:
        return now_ns - self.last_ns >= QUIET_NS or now_ns - self.first_ns >= MOST_NS


def request_resolve(late: dict[str, PendingResolve], unit_id: str, now_ns: int) -> None:
    waiting = late.setdefault(unit_id, PendingResolve(now_ns, now_ns))
    waiting.last_ns = now_ns


def pop_due(late: dict[str, PendingResolve], now_ns: int) -> str | None:
    """Remove and return the unit that has waited longest; None where nothing is due."""
    due = [
        (waiting.first_ns, unit_id) for unit_id, waiting in late.items() if waiting.is_due(now_ns)
    ]
    if not due:
        return None
    _, unit_id = min(due)
    del late[unit_id]
    return unit_id
