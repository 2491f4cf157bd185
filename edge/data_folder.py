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

    @property
    def calibrations(self) -> Path:
        """Those ever used, by their identity: without them the black box's raw samples do not
        give the same positions again.
        """
        return self.path / "calibrations"

    def close(self) -> None:
        self._lock.close()
