"""Limit of open files and connections of this process."""

from __future__ import annotations

import contextlib
import resource


def allow_many_files() -> None:
    """Raise the limit to what the machine allows, so that connections leave enough files for the
    log.
    """
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
