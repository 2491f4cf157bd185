"""Ownership of files that root makes: they belong to the folder's owner, so that a command given
as root beside a service of another user leaves nothing behind that the service cannot use.

And no link leads out of it: a user with write access to the folder could else make root empty any
file, or give it away.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from io import BufferedReader, BufferedWriter
from pathlib import Path

from shared.durable_names import sync_folder
from shared.errors import LinkRefusedError

_IS_LINK = "it is a link, which is not followed: remove it"
_IS_SHARED = "it is no file of its own but a second name or a device: remove it"


def open_own(path: Path, flags: int, mode: int) -> int:
    """As ``os.open``, of a plain file; a link is not followed, and nothing is emptied before that
    is known.
    """
    try:
        descriptor = os.open(path, (flags & ~os.O_TRUNC) | os.O_NOFOLLOW | os.O_NONBLOCK, mode)
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise OSError(errno.ELOOP, _IS_LINK, str(path)) from error
        raise
    with ExitStack() as undo:
        undo.callback(os.close, descriptor)
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode) or _is_of_another(found, path.parent):
            raise OSError(errno.EMLINK, _IS_SHARED, str(path))
        if flags & os.O_TRUNC:
            os.ftruncate(descriptor, 0)
        if flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            give_to_owner(descriptor, path.parent)
        undo.pop_all()
    return descriptor


def _is_of_another(found: os.stat_result, folder: Path) -> bool:
    """True if it has a second name, and root would give it away; what a snapshot shares with the
    folder has the folder's owner.
    """
    return os.geteuid() == 0 and found.st_nlink > 1 and found.st_uid != folder.stat().st_uid


def read_own(path: Path) -> BufferedReader:
    """To read what is in the folder itself; raises OSError for a link."""
    return os.fdopen(open_own(path, os.O_RDONLY, 0), "rb")


def write_own(path: Path, mode: int = 0o666) -> BufferedWriter:
    """A new, empty file in place of what may be there; a link is replaced, not followed."""
    path.unlink(missing_ok=True)
    return os.fdopen(open_own(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb")


def append_own(path: Path, mode: int = 0o666) -> BufferedWriter:
    """To go on with a file that is there, or a new one; raises OSError for a link."""
    return os.fdopen(open_own(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, mode), "ab")


def refuse_links(folder: Path, part: str = "") -> None:
    """LinkRefusedError where something in the folder, or in that part of it, leads out of it;
    ``folder`` itself may be reached by a link, as the caller names it.

    The check is done once, before anything else: a folder that is exchanged for a link while a
    command of root runs is refused only at its files (``open_own``).
    """
    top = folder.resolve()
    for path in _all_in(top / part):
        if path.is_symlink() and not _leads_inside(path, top):
            raise LinkRefusedError(
                f"{path} is a link that leads out of {folder}, and is not followed: remove it, "
                "or put there what it leads to (another disk can be mounted there)"
            )


def _all_in(folder: Path) -> Iterator[Path]:
    """With itself; what links lead to is not looked into."""
    yield folder
    for at, folders, files in os.walk(folder):
        yield from (Path(at, name) for name in (*folders, *files))


def _leads_inside(link: Path, top: Path) -> bool:
    try:
        return link.resolve().is_relative_to(top)
    except (OSError, RuntimeError):  # round in a circle: it leads nowhere
        return True


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
    """Give an open file or folder to the owner of ``folder``; only root can, and only root has to.

    It stays as it is where the file system has no owners, or does not change them.
    """
    if os.geteuid() == 0:
        with suppress(OSError):
            owner = folder.stat()
            os.fchown(descriptor, owner.st_uid, owner.st_gid)
