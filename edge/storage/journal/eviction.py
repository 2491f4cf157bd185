"""Eviction of journal rows: first what the station is known to have, then the oldest of the
lowest priority.
"""

from __future__ import annotations

import sqlite3

from edge.storage.journal.schema import PRIORITIES

_ROWS_PER_STEP = 50
_EVICT_DOWN_TO = 0.95  # of the limit, so that room is not made at every append


def bytes_used(writer: sqlite3.Connection) -> int:
    (pages,) = writer.execute("PRAGMA page_count").fetchone()
    (free,) = writer.execute("PRAGMA freelist_count").fetchone()
    (page_bytes,) = writer.execute("PRAGMA page_size").fetchone()
    return int((pages - free) * page_bytes)


def evict(writer: sqlite3.Connection, limit_bytes: int) -> int:
    """Evict in one transaction; return how many messages went that the station may not have."""
    with writer:
        for number, to_seq in writer.execute(
            "SELECT number, acknowledged_seq FROM boot WHERE acknowledged_seq > 0 ORDER BY number"
        ).fetchall():
            for priority in PRIORITIES:
                known = (priority, number, to_seq)
                _evict_while_full(writer, limit_bytes, "worth = ? AND boot = ? AND seq <= ?", known)
        return sum(
            _evict_while_full(writer, limit_bytes, "worth = ?", (one,)) for one in PRIORITIES
        )


def _evict_while_full(
    writer: sqlite3.Connection, limit_bytes: int, condition: str, arguments: tuple[int, ...]
) -> int:
    """Evict rows until there is room or none of these is left; return how many."""
    freed = 0
    while bytes_used(writer) > _EVICT_DOWN_TO * limit_bytes:
        rows = _evict_rows(writer, condition, arguments)
        if not rows:
            break
        freed += rows
    return freed


def _evict_rows(writer: sqlite3.Connection, condition: str, arguments: tuple[int, ...]) -> int:
    cursor = writer.execute(
        "DELETE FROM message WHERE (worth, boot, seq) IN (SELECT worth, boot, seq "  # noqa: S608  # all text is ours
        f"FROM message WHERE {condition} ORDER BY worth, boot, seq LIMIT ?)",
        (*arguments, _ROWS_PER_STEP),
    )
    return cursor.rowcount
