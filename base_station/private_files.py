"""Files for their owner alone, such as the authority's: there whole or not at all, also after a
power cut.
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from shared.errors import ConfigError


@contextmanager
def new_folder(folder: Path) -> Iterator[None]:
    """Make it, mode 0700; where the block fails nothing is left of it.

    Raises ConfigError where it cannot be made, or is there already.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=0o700)
        if os.geteuid() == 0:
            owner = folder.parent.stat()
            os.chown(folder, owner.st_uid, owner.st_gid)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be made: {error.strerror or error}") from error
    try:
        yield
    except ConfigError:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def write_atomically(path: Path, content: bytes) -> None:
    """Replace ``path``, mode 0600; after a power cut it has the old or the new content.

    Raises ConfigError where it cannot.
    """
    write_together({path: content})


def write_together(contents: Mapping[Path, bytes]) -> None:
    """Replace files of one folder that belong together, as ``write_atomically``: where the disk
    does not take all of them, all stay as they were.
    """
    partials = {path: path.with_name(path.name + ".partial") for path in contents}
    path = next(iter(contents))
    try:
        for path, content in contents.items():
            _write_new(partials[path], content)
        for path, partial in partials.items():
            partial.replace(path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        with suppress(OSError):
            for partial in partials.values():
                partial.unlink(missing_ok=True)
        raise ConfigError(f"{path} cannot be written: {error.strerror or error}") from error


def _write_new(path: Path, content: bytes) -> None:
    path.unlink(missing_ok=True)
    descriptor = _open_own(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """One command at a time changes the folder; the next waits."""
    try:
        lock = _open_own(folder / "lock", os.O_RDONLY | os.O_CREAT)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be used: {error.strerror or error}") from error
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
    finally:
        os.close(lock)


def _open_own(path: Path, flags: int) -> int:
    """Mode 0600; what root makes belongs to the folder's owner, as whom the station runs."""
    descriptor = os.open(path, flags, 0o600)
    if os.geteuid() == 0:
        owner = path.parent.stat()
        os.chown(descriptor, owner.st_uid, owner.st_gid)
    return descriptor
