"""The folder in which one unit keeps its journal and its black box; one agent at a time."""

from __future__ import annotations

from pathlib import Path

from shared.folder_lock import FolderLock


class DataFolder:
    """Held from making to ``close``; the system lets go of it when the process dies."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = FolderLock(path, "agent", "stop it, or give this unit another id or folder")

    @property
    def journal(self) -> Path:
        return self.path / "journal.sqlite"

    @property
    def black_box(self) -> Path:
        return self.path / "black_box"

    def close(self) -> None:
        self._lock.close()
