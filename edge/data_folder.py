"""The folder in which one unit keeps its journal and its black box; one agent at a time."""

from __future__ import annotations

from contextlib import suppress
from itertools import count
from pathlib import Path

from shared.errors import LogError
from shared.folder_lock import FolderLock

_OWNER = "unit"


class DataFolder:
    """Held from making to ``close``; the system lets go of it when the process dies.

    It has the unit's name.  ``set_aside`` is where another unit's journal and black box went, which
    were found in it (somebody copied the folder): this one must not say what that one has.
    """

    def __init__(self, path: Path) -> None:
        """Raises DataFolderInUseError while another agent holds it, LogError where it is no use."""
        self.path = path
        self._lock = FolderLock(path, "agent", "stop it, or give this unit another id or folder")
        try:
            self.set_aside = self._make_own()
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
    def calibrations(self) -> Path:
        """Those ever used, by their identity: without them the black box's raw samples do not
        give the same positions again.
        """
        return self.path / "calibrations"

    def _make_own(self) -> Path | None:
        note, owner, aside = self.path / _OWNER, "", None
        with suppress(OSError, UnicodeDecodeError):  # nobody has said so: it is this one's
            # Zeros are what a power cut left of it.
            owner = note.read_text(encoding="utf-8").replace("\0", "").strip()
        if owner == self.path.name:
            return None
        if owner:
            number = next(n for n in count(1) if not (self.path / f"of-another-{n}").exists())
            aside = self.path / f"of-another-{number}"
            aside.mkdir()
            for kept in (*self.path.glob("journal.sqlite*"), self.black_box):
                if kept.exists():
                    kept.rename(aside / kept.name)
        with suppress(OSError):  # a full disk stops no unit
            note.write_text(f"{self.path.name}\n", encoding="utf-8")
        return aside

    def close(self) -> None:
        self._lock.close()
