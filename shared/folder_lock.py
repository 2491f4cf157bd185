"""One program at a time for a folder; the system lets go when the program dies."""

from __future__ import annotations

import errno
import fcntl
import os
from contextlib import suppress
from pathlib import Path

from shared.errors import DataFolderInUseError, LogError
from shared.own_files import make_folder, open_own

_NAME = "lock"


class FolderLock:
    """Held from making until ``close``."""

    def __init__(
        self,
        folder: Path,
        holder: str = "station",
        remedy: str = "stop it, or give this one another folder with --data",
    ) -> None:
        """Makes the folder where it is missing.

        ``holder`` says who may hold it ("station"), ``remedy`` what to do when another one does.
        Raises DataFolderInUseError, which names the process that holds it, or LogError when the
        folder cannot be used at all.
        """
        try:
            make_folder(folder)
            self._descriptor = _opened(folder / _NAME)
        except OSError as error:
            raise LogError(f"the data folder {folder} cannot be used: {error.strerror}") from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            process = os.pread(self._descriptor, 20, 0).decode("ascii", "replace").strip()
            os.close(self._descriptor)
            raise DataFolderInUseError(
                f"another {holder} is using {folder} (process {process or 'unknown'}): {remedy}"
            ) from error
        with suppress(OSError):  # a disk that is full: it is held, and cannot be said by whom
            os.ftruncate(self._descriptor, 0)
            os.pwrite(self._descriptor, f"{os.getpid()}\n".encode("ascii"), 0)

    @staticmethod
    def is_held(folder: Path) -> bool:
        """Whether a program holds it now; who asks holds it for no longer than that takes."""
        try:
            descriptor = os.open(folder / _NAME, os.O_RDONLY)
        except OSError:
            return False
        try:
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        finally:
            os.close(descriptor)
        return False

    def close(self) -> None:
        os.close(self._descriptor)


def _opened(lock: Path) -> int:
    try:
        return open_own(lock, os.O_RDWR | os.O_CREAT, 0o640)
    except OSError as error:
        if error.errno != errno.EROFS:
            raise
        return os.open(lock, os.O_RDONLY)  # a disk that has failed: it can be held all the same
