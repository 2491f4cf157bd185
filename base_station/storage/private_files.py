"""Files for their owner alone, such as the authority's: there whole or not at all, also after a
power cut.  Raises StoreError throughout where the disk does not take them.
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from shared.coded_text import coded
from shared.errors import StoreError
from shared.file_faults import making_fault, writing_fault
from shared.own_files import make_folder, make_new_folder, open_own

_FOLDER = 0o700
_FILE = 0o600


@contextmanager
def new_folder(folder: Path) -> Iterator[None]:
    """Make a new folder; raises where it is there already, and removes it if the block fails."""
    try:
        make_folder(folder.parent, _FOLDER)
        make_new_folder(folder, _FOLDER)
    except OSError as error:
        raise StoreError(making_fault(folder, error)) from error
    with ExitStack() as undo:
        undo.callback(shutil.rmtree, folder, ignore_errors=True)
        yield
        undo.pop_all()


def write_atomically(path: Path, content: bytes) -> None:
    """Replace ``path``; after a power cut it has the old or the new content."""
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
        raise StoreError(writing_fault(path, error)) from error


def _write_new(path: Path, content: bytes) -> None:
    path.unlink(missing_ok=True)
    descriptor = open_own(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, _FILE)
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """One command at a time changes the folder; the next waits."""
    try:
        lock = open_own(folder / "lock", os.O_RDONLY | os.O_CREAT, _FILE)
    except OSError as error:
        raise StoreError(
            coded(
                "folder-unusable",
                "{folder} cannot be used: {error}",
                folder=str(folder),
                error=error.strerror or str(error),
            )
        ) from error
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
    finally:
        os.close(lock)
