"""A journal of which the disk has lost a page."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path


def spoil_page(file: Path, which: str) -> None:
    """The journal opens all the same; ``which`` asks it for the page's number."""
    with closing(sqlite3.connect(file)) as journal:
        (page,) = journal.execute(which).fetchone()
        (page_bytes,) = journal.execute("PRAGMA page_size").fetchone()
    content = bytearray(file.read_bytes())
    content[(page - 1) * page_bytes : page * page_bytes] = b"\xff" * page_bytes
    file.write_bytes(content)
