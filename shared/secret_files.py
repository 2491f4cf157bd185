"""Files that their owner alone may read, such as private keys: one that others can read is closed
to them, and reported, as another user may have read it.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from shared.own_files import open_own

OTHERS = 0o007  # users who are neither the owner nor of the group
ALL_BUT_OWNER = 0o077


def close_to_others(path: Path, whom: int = ALL_BUT_OWNER) -> int:
    """Take away what ``whom`` may do with it; the mode that it had, 0 where that was nothing.

    Raises PermissionError where it cannot be taken away, as from a file of another user, or on a
    file system that knows no modes.
    """
    mode = stat.S_IMODE(path.stat().st_mode)
    if not mode & whom:
        return 0
    descriptor = open_own(path, os.O_RDONLY, 0)
    try:
        os.fchmod(descriptor, mode & ~whom)
        if stat.S_IMODE(os.fstat(descriptor).st_mode) & whom:
            raise PermissionError(0, "the file system keeps no modes", str(path))
    finally:
        os.close(descriptor)
    return mode


def exposed(path: Path, mode: int) -> str:
    """For a person."""
    was = f"could be read or changed by others (mode {mode:04o})"
    return f"{path} {was} and has been closed to them"
