"""Monitor of threads that a bug has ended: they are reported to people."""

from __future__ import annotations

import logging
import threading

from shared.coded_text import coded

log = logging.getLogger(__name__)


class ThreadCrashMonitor:
    """Monitor of this process's threads while it is entered; the other threads continue."""

    def __init__(self) -> None:
        self._names: list[str] = []

    def __enter__(self) -> ThreadCrashMonitor:
        self._before = threading.excepthook
        threading.excepthook = self._note
        return self

    def __exit__(self, *_: object) -> None:
        threading.excepthook = self._before

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console; they stay until the station starts again."""
        return tuple(
            coded(
                "part-ended",
                "A part of the station has ended by a mistake in the program ({name}): start the "
                "station again at the next quiet moment, and report it",
                name=name,
            )
            for name in self._names
        )

    def _note(self, ended: threading.ExceptHookArgs) -> None:
        name = "unknown" if ended.thread is None else ended.thread.name
        log.critical("the station's thread %s has ended", name, exc_info=ended.exc_value)
        if name not in self._names:
            self._names.append(name)
