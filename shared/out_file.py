"""Output file of a command: the command fails at its beginning where the file cannot be written,
and leaves no part of it behind.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from shared.errors import ConfigError, UserError
from shared.own_files import write_own


def writable(path: Path | None) -> Path | None:
    """The callback of an option that names such a file; what is there already stays as it is.

    Raises UserError where no file can be written.
    """
    if path is None:
        return None
    is_new = not path.exists()
    if is_new and path.is_symlink():
        raise UserError(f"{path} is a link to what is not there; choose another place")
    try:
        with path.open("ab"):
            pass
        if is_new:
            path.unlink()
    except OSError as error:
        raise _not_written(path, error) from error
    return path


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Temporary path to write to; it becomes ``path`` when all of it is written, and is removed
    otherwise.

    Raises UserError where the disk does not take it.
    """
    is_file = path.is_file() or not path.exists()  # what is no file is written as it comes
    making = path.with_name(f".part-{path.name}") if is_file else path
    try:
        if is_file:  # no link of another user in that folder is followed
            write_own(making).close()
        yield making
        if is_file:
            making.replace(path)
    except OSError as error:
        raise _not_written(path, error) from error
    finally:
        if is_file:
            making.unlink(missing_ok=True)


def _not_written(path: Path, error: OSError) -> UserError:
    return UserError(f"cannot write {path}: {error.strerror or error}; choose another place")


def write_secret(path: Path, content: bytes, again: str) -> None:
    """A new file that its owner alone can read.  ``again``: what makes what it holds once more.

    Raises ConfigError where one is already, or where the disk does not take all of it: then
    nothing is left of it.
    """
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise ConfigError(f"{path} is there already; move it away or choose another") from None
    except OSError as error:
        raise ConfigError(f"{path} cannot be written: {error.strerror}") from error
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        path.unlink()
        raise ConfigError(
            f"{path} cannot be written ({error.strerror}), and nothing is left of it; free the "
            f"disk or choose another place, and make it again: {again}"
        ) from error
