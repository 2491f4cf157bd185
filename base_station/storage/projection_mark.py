"""Mark of the time since which the tables may lack records of the log; it survives a kill."""

from __future__ import annotations

from pathlib import Path

from base_station.storage.private_files import write_atomically
from shared.errors import StoreError
from shared.file_faults import removal_fault
from shared.own_files import read_own


class ProjectionMark:
    """A file in the data folder, which is there while the tables are behind."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def since_ns(self) -> int | None:
        """Station time; 0 where the file cannot be read: since ever.  None: nothing is missing."""
        try:
            with read_own(self._path) as file:
                return int(file.read())
        except FileNotFoundError:
            return None
        except (OSError, ValueError):
            return 0

    def note(self, since_ns: int) -> None:
        """Raises StoreError where the disk does not take it."""
        write_atomically(self._path, str(since_ns).encode())

    def clear(self) -> None:
        """Raises StoreError."""
        try:
            self._path.unlink(missing_ok=True)
        except OSError as error:
            raise StoreError(removal_fault(self._path, error)) from error
