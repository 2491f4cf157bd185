"""A file that a command writes at its end: that it cannot be written is said at the beginning."""

from __future__ import annotations

from pathlib import Path

from shared.errors import UserError


def writable(path: Path | None) -> Path | None:
    """The callback of an option that names such a file; what is there already stays as it is.

    Raises UserError where no file can be written.
    """
    if path is None:
        return None
    is_new = not path.exists()
    try:
        with path.open("ab"):
            pass
        if is_new:
            path.unlink()
    except OSError as error:
        raise not_written(path, error) from error
    return path


def not_written(path: Path, error: OSError) -> UserError:
    return UserError(f"cannot write {path}: {error.strerror}; choose another place")
