"""Makes room in the journal: what the station is known to have goes first, then the oldest of the
least worth.
"""

from __future__ import annotations

import sqlite3

from edge.journal.rows import WORTHS

_ROWS_FREED_AT_ONCE = 50
_FREE_DOWN_TO = 0.95  # of the limit, so that room is not made at every append


def bytes_used(writer: sqlite3.Connection) -> int:
    (pages,) = writer.execute("PRAGMA page_count").fetchone()
    (free,) = writer.execute("PRAGMA freelist_count").fetchone()
    (page_bytes,) = writer.execute("PRAGMA page_size").fetchone()
    return int((pages - free) * page_bytes)


def make_room(writer: sqlite3.Connection, limit_bytes: int) -> int:
    """In one transaction; returns how many messages were given up that the station may not have."""
    with writer:
        for number, to_seq in writer.execute(
            "SELECT number, acknowledged_seq FROM boot WHERE acknowledged_seq > 0 ORDER BY number"
        ).fetchall():
            for worth in WORTHS:
                known = (worth, number, to_seq)
                _free_while_full(writer, limit_bytes, "worth = ? AND boot = ? AND seq <= ?", known)
        return sum(_free_while_full(writer, limit_bytes, "worth = ?", (one,)) for one in WORTHS)


def _free_while_full(
    writer: sqlite3.Connection, limit_bytes: int, condition: str, arguments: tuple[int, ...]
) -> int:
    """How many rows were freed: none of these is left, or there is room."""
    freed = 0
    while bytes_used(writer) > _FREE_DOWN_TO * limit_bytes:
        rows = _free(writer, condition, arguments)
        if not rows:
            break
        freed += rows
    return freed


def _free(writer: sqlite3.Connection, condition: str, arguments: tuple[int, ...]) -> int:
    cursor = writer.execute(
        "DELETE FROM message WHERE (worth, boot, seq) IN (SELECT worth, boot, seq "  # noqa: S608  # all text is ours
        f"FROM message WHERE {condition} ORDER BY worth, boot, seq LIMIT ?)",
        (*arguments, _ROWS_FREED_AT_ONCE),
    )
    return cursor.rowcount
