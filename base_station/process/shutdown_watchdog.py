"""Watchdog that ends a station which was asked to end and whose disk does not answer.

A thread that waits for such a disk in the kernel can neither be woken nor left behind, so each part
of the station would have to handle that.  No more is lost by this than by a kill.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Callable
from threading import Event, Lock, Thread

log = logging.getLogger(__name__)

EXIT_CODE = 1
_PATIENCE_S = 6.0  # with a disk that may answer yet
_POLL_INTERVAL_S = 0.5


class ShutdownWatchdog:
    """Watchdog; its context is left when all has ended in order."""

    def __init__(self) -> None:
        self._is_over = Event()
        self._lock = Lock()
        self._has_begun = False

    def __enter__(self) -> ShutdownWatchdog:
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over.set()

    def begin(self, unsaved_loss: Callable[[], str], end_children: Callable[[], None]) -> None:
        """Begin to watch.  Thread-safe; may be called more than once.

        ``unsaved_loss``: sentence about records that are lost on a disk that hangs; empty if it
        answers.  ``end_children`` ends processes that would outlive this program.
        """
        with self._lock:
            if self._has_begun:
                return
            self._has_begun = True
        Thread(
            target=self._watch, args=(unsaved_loss, end_children), name="end-in-time", daemon=True
        ).start()

    def _watch(self, unsaved_loss: Callable[[], str], end_children: Callable[[], None]) -> None:
        patience_s = _PATIENCE_S
        while not self._is_over.wait(patience_s):
            patience_s = _POLL_INTERVAL_S
            if lack := unsaved_loss():
                log.critical("ended although the disk does not answer: %s", lack)
                end_children()
                os._exit(EXIT_CODE)
