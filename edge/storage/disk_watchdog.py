"""Watchdog of a thread that waits for the disk: worn cards hang, now and then or for good."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from shared.worker import Worker

HANGS_S = 5.0  # a worn card may take some seconds now and then
_POLL_S = 0.2


class DiskWatchdog:
    """Watchdog: the thread reports when it begins to wait and when it goes on; any thread may
    ask.
    """

    def __init__(self) -> None:
        self._started_s: float | None = None  # since when the disk owes an answer

    @contextmanager
    def request(self) -> Iterator[None]:
        """Enter while the disk owes an answer."""
        self._started_s = time.monotonic()
        try:
            yield
        finally:
            self._started_s = None

    @property
    def waiting_s(self) -> float:
        started_s = self._started_s
        return 0.0 if started_s is None else time.monotonic() - started_s

    @property
    def hangs(self) -> bool:
        return self.waiting_s > HANGS_S

    def join(self, worker: Worker) -> bool:
        """Wait for the worker's end; return False if the disk hangs, and it may never come."""
        while not worker.join(_POLL_S):
            if self.hangs:
                return False
        return True
