"""A station's database, damaged as a disk that fails does it."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path


def spoil_table(path: Path, table: str) -> None:
    """Its first page is overwritten."""
    with closing(sqlite3.connect(path)) as reading:
        wanted = "SELECT rootpage FROM sqlite_master WHERE name = ?"
        (page,) = reading.execute(wanted, [table]).fetchone()
        (page_bytes,) = reading.execute("PRAGMA page_size").fetchone()
    with path.open("r+b") as file:
        file.seek((page - 1) * page_bytes)
        file.write(b"\xee" * page_bytes)
