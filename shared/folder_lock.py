"""Lock of a folder for one program; the system releases it when the program ends.  The folder
itself is locked, so that changes of its files do not matter.  So is the file ``lock``, which names
the holder, and is the only lock of earlier versions.
"""

from __future__ import annotations

import errno
import fcntl
import os
from contextlib import suppress
from pathlib import Path

from shared.errors import DataFolderInUseError, LogError
from shared.own_files import make_folder, open_own, refuse_links

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
        Raises DataFolderInUseError, which names the process that holds it, LogError when the folder
        cannot be used at all, or LinkRefusedError where something in it leads out of it.
        """
        in_use = f"another {holder} is using {folder} (process {{}}): {remedy}"
        try:
            make_folder(folder)
            refuse_links(folder)
            self._folder = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        except OSError as error:
            raise LogError(f"the data folder {folder} cannot be used: {error.strerror}") from error
        try:
            if not _is_free(self._folder, fcntl.LOCK_EX):
                raise DataFolderInUseError(in_use.format(_holder_of(folder)))
            self._file = self._opened(folder / _NAME)
        except OSError as error:
            os.close(self._folder)
            why = error.strerror
            raise LogError(f"the data folder {folder} cannot be used: {why}") from error
        except DataFolderInUseError:
            os.close(self._folder)
            raise
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            process = _process_in(self._file)
            self.close()
            raise DataFolderInUseError(in_use.format(process)) from error
        with suppress(OSError):  # a full disk: the lock is held, only without the process's id
            os.ftruncate(self._file, 0)
            os.pwrite(self._file, f"{os.getpid()}\n".encode("ascii"), 0)

    @staticmethod
    def is_held(folder: Path) -> bool:
        """True if a program holds it now; who asks holds it for no longer than that takes."""
        for path in (folder, folder / _NAME):
            try:
                descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW * (path != folder))
            except OSError:
                continue
            try:
                if not _is_free(descriptor, fcntl.LOCK_SH):
                    return True
            finally:
                os.close(descriptor)
        return False

    def close(self) -> None:
        os.close(self._file)
        os.close(self._folder)

    def _opened(self, lock: Path) -> int:
        try:
            return open_own(lock, os.O_RDWR | os.O_CREAT, 0o640)
        except OSError as error:
            if error.errno != errno.EROFS:
                raise
        try:  # a disk that has failed: it can be held all the same
            return open_own(lock, os.O_RDONLY, 0)
        except FileNotFoundError:
            return os.dup(self._folder)


def _is_free(descriptor: int, how: int) -> bool:
    """Take the lock where no other process has it.  On a file system that locks no folders it is
    free: the lock of the file decides.
    """
    try:
        fcntl.flock(descriptor, how | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True


def _holder_of(folder: Path) -> str:
    try:
        descriptor = os.open(folder / _NAME, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return "unknown"
    try:
        return _process_in(descriptor)
    finally:
        os.close(descriptor)


def _process_in(descriptor: int) -> str:
    with suppress(OSError):
        return os.pread(descriptor, 20, 0).decode("ascii", "replace").strip() or "unknown"
    return "unknown"
