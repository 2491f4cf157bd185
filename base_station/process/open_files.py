"""Limit of open files and connections of this process."""

from __future__ import annotations

import contextlib
import resource


def allow_many_files() -> None:
    """As many as the machine allows: connections must not take them from the log."""
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
