"""What root makes in a folder belongs to the folder's owner: a command that is given as root beside
a service that runs as another user leaves nothing behind that the service cannot use.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from shared.durable_names import sync_folder


def open_own(path: Path, flags: int, mode: int) -> int:
    """As ``os.open``."""
    descriptor = os.open(path, flags, mode)
    give_to_owner(descriptor, path.parent)
    return descriptor


def make_folder(folder: Path, mode: int = 0o777) -> None:
    """With those around it where they are missing; one that is there stays as it is."""
    if folder.is_dir():
        return
    make_folder(folder.parent)
    try:
        make_new_folder(folder, mode)
    except FileExistsError:
        if not folder.is_dir():
            raise


def make_new_folder(folder: Path, mode: int) -> None:
    """It outlives a power cut, as what is kept in it could not without it; or it is not there.

    Raises FileExistsError where there is something of that name.
    """
    folder.mkdir(mode)
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        try:
            give_to_owner(descriptor, folder.parent)
        finally:
            os.close(descriptor)
        sync_folder(folder.parent)
    except OSError:
        folder.rmdir()
        raise


def give_to_owner(descriptor: int, folder: Path) -> None:
    """Of what is open and stands in ``folder``; only root can give, and nobody else has to.

    Where the file system knows no owners, or takes no other ones, it stays as it is.
    """
    if os.geteuid() == 0:
        with suppress(OSError):
            owner = folder.stat()
            os.fchown(descriptor, owner.st_uid, owner.st_gid)
