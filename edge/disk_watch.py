"""How long a thread has waited for the disk: worn cards hang, now and then or for good."""

from __future__ import annotations

import time
from threading import Thread

HANGS_S = 5.0  # a worn card may take some seconds now and then
_LOOK_EVERY_S = 0.2


class DiskWatch:
    """The thread that waits says when it begins to and when it is answered; any thread asks."""

    def __init__(self) -> None:
        self._asked_s: float | None = None  # since when the disk owes an answer

    def asked(self) -> None:
        self._asked_s = time.monotonic()

    def answered(self) -> None:
        self._asked_s = None

    @property
    def owed_for_s(self) -> float:
        asked_s = self._asked_s
        return 0.0 if asked_s is None else time.monotonic() - asked_s

    @property
    def hangs(self) -> bool:
        return self.owed_for_s > HANGS_S

    def join(self, thread: Thread) -> bool:
        """Wait for the thread's end; False: the disk hangs, and it may never come."""
        while thread.is_alive():
            thread.join(_LOOK_EVERY_S)
            if self.hangs:
                return False
        return True
