"""The folder in which one unit keeps its journal and its black box; one agent at a time."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

from shared.errors import ConfigError, DataFolderInUseError


class DataFolder:
    """Held from making to ``close``; the system lets go of it when the process dies."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(path / "lock", os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            raise ConfigError(
                f"data folder {path} cannot be used: {error.strerror}; name another with --data"
            ) from error
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(self._lock)
            raise DataFolderInUseError(
                f"another agent is using {path}; stop it, or give this unit another id or folder"
            ) from error

    @property
    def journal(self) -> Path:
        return self.path / "journal.sqlite"

    @property
    def black_box(self) -> Path:
        return self.path / "black_box"

    def close(self) -> None:
        os.close(self._lock)
