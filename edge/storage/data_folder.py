"""Data folder of one unit: its journal, black box and mayday; one agent at a time."""

from __future__ import annotations

from contextlib import suppress
from itertools import count
from pathlib import Path

from shared.errors import LogError
from shared.folder_lock import FolderLock
from shared.own_files import write_own

STEP_SCALES = "step_scales.json"
_OWNER = "unit"


class UnitDataFolder:
    """Folder, locked from making to ``close``; the system unlocks it when the process dies.

    It has the unit's name.  ``quarantine`` is where journal and black box of another unit went that
    were found in it (a copied folder): this unit must not publish the other's data.
    """

    def __init__(self, path: Path) -> None:
        """Raises DataFolderInUseError while another agent holds it, LogError where it is no use."""
        self.path = path
        self._lock = FolderLock(path, "agent", "stop it, or give this unit another id or folder")
        try:
            self.quarantine = self._make_own()
        except OSError as error:
            self._lock.close()
            raise LogError(f"the data folder {path} cannot be used: {error.strerror}") from error

    @property
    def journal(self) -> Path:
        return self.path / "journal.sqlite"

    @property
    def black_box(self) -> Path:
        return self.path / "black_box"

    @property
    def mayday(self) -> Path:
        """File that is there while the wearer's mayday is active."""
        return self.path / "mayday"

    @property
    def open_commands(self) -> Path:
        return self.path / "open_commands.json"

    @property
    def step_scales(self) -> Path:
        """Learnt lengths of the steps of those who have worn it."""
        return self.path / STEP_SCALES

    @property
    def calibrations(self) -> Path:
        """Calibrations ever used, by their identity: the raw samples are computed with them."""
        return self.path / "calibrations"

    def _make_own(self) -> Path | None:
        owner_file, owner, quarantine = self.path / _OWNER, "", None
        with suppress(OSError, UnicodeDecodeError):  # without an owner's name it is this unit's
            # Zeros are what a power cut left of it.
            owner = owner_file.read_text(encoding="utf-8").replace("\0", "").strip()
        if owner == self.path.name:
            return None
        if owner:
            number = next(n for n in count(1) if not (self.path / f"of-another-{n}").exists())
            quarantine = self.path / f"of-another-{number}"
            quarantine.mkdir()
            for kept in (*self.path.glob("journal.sqlite*"), self.black_box, self.mayday):
                if kept.exists():
                    kept.rename(quarantine / kept.name)
        with suppress(OSError), write_own(owner_file) as written:  # a full disk stops no unit
            written.write(f"{self.path.name}\n".encode())
        return quarantine

    def close(self) -> None:
        self._lock.close()
