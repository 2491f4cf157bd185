"""Messages that a unit has ever published, by its own journal."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

MessageOfUnit = tuple[int, int]  # boot id, sequence number


def stated_by(journal: Path) -> set[MessageOfUnit]:
    """Messages in the journal of an agent that may be writing to it, or has not begun to."""
    if not journal.exists():
        return set()
    with closing(sqlite3.connect(f"file:{journal}?mode=ro", uri=True)) as database:
        laid_out = database.execute("SELECT 1 FROM sqlite_master WHERE name = 'message'")
        if laid_out.fetchone() is None:  # the agent has only just made the file
            return set()
        rows = database.execute(
            "SELECT boot_id, seq FROM message JOIN boot ON boot.number = message.boot"
        ).fetchall()
    return {(boot_id % 2**64, seq) for boot_id, seq in rows}
