"""What stands where in a station's data folder."""

from __future__ import annotations

from pathlib import Path

from base_station.recorder import LOG_FOLDER
from shared.errors import LogError, StoreError
from shared.folder_lock import FolderLock


class DataFolder:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.log = path / LOG_FOLDER
        self.checkpoints = path / "checkpoints"
        self.recordings = path / "recordings"  # of units' raw sensors, pulled on request
        self.database = path / "station.sqlite"
        self.forgettings = path / "forgetting.json"  # what is to be forgotten, until it is
        self.first_login = path / "first-login.txt"

    def require(self) -> None:
        """LogError where there is nothing to read."""
        if not self.log.is_dir():
            raise LogError(f"there is no station's log in {self.path}; give the folder with --data")

    def require_database(self) -> Path:
        """StoreError where no station has ever run here."""
        if not self.database.exists():
            raise StoreError(
                f"there is no station's database in {self.path}; give the folder with --data, or "
                "start the station there once"
            )
        return self.database

    def lock(self) -> FolderLock:
        """To change what is in it; DataFolderInUseError while a station works on it."""
        return FolderLock(self.path, "station", "stop it first")
