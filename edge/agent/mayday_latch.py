"""Latch of the mayday on disk: it stays active over restarts of the agent, until the wearer cancels
it.  The latch is a file that exists while the mayday is active; its text is for a person.  The file
is renamed when it is on the disk, and its folder is flushed after each change: a power cut leaves
the state before or after.  A thread of its own writes, so that the disk does not delay the call.
"""

from __future__ import annotations

import logging
import os
from datetime import UTC, datetime
from pathlib import Path

from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.durable_names import sync_folder
from shared.own_files import write_own
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

_CLOSE_TIMEOUT_S = 5.0  # then a disk that hangs is not waited for


class MaydayLatch:
    """Latch of one unit; ``set`` never waits and never raises, ``fault`` reports what fails."""

    def __init__(self, path: Path, clock: Clock) -> None:
        self._path = path
        self._clock = clock
        self._read_fault: str = ""
        self.was_active = self._read()  # when the agent ended
        self._is_on_disk = self.was_active
        self._is_active = self.was_active
        self._worker = Worker(
            "mayday-latch", self._step, "the mayday is not kept on disk", at_end=self._save
        )
        self._worker.start()

    @property
    def fault(self) -> str:
        """Fault of the disk as a sentence; empty where there is none."""
        if self._worker.fault:
            return coded(
                "mayday-not-kept",
                "the mayday's state would not survive a restart: {error}",
                error=self._worker.fault,
            )
        return self._read_fault

    def set(self, *, is_active: bool) -> None:
        if is_active != self._is_active:
            self._is_active = is_active
            self._worker.wake()

    def close(self) -> None:
        """Write what is not written yet, unless the disk hangs."""
        if not self._worker.close(_CLOSE_TIMEOUT_S):
            logger.error("the disk hangs: the mayday's state is not kept")

    def _read(self) -> bool:
        try:
            return self._path.lstat() is not None
        except FileNotFoundError:
            return False
        except OSError as error:  # a unit must start in any case
            self._read_fault = coded(
                "mayday-not-read",
                "whether a mayday was active cannot be read: {error}",
                error=str(error),
            )
            return False

    def _step(self) -> float:
        self._save()
        return UNTIL_WOKEN

    def _save(self) -> None:
        """Bring the state to the disk.  Raises OSError; may be repeated."""
        is_active = self._is_active
        if is_active == self._is_on_disk:
            return
        if is_active:
            self._write()
        else:
            self._path.unlink(missing_ok=True)
        sync_folder(self._path.parent)
        self._is_on_disk = is_active

    def _write(self) -> None:
        now = datetime.fromtimestamp(self._clock.utc_ns() // NS_PER_S, UTC)
        new = self._path.with_suffix(".new")
        with write_own(new) as written:
            written.write(f"mayday active since {now:%Y-%m-%dT%H:%M:%SZ}\n".encode())
            written.flush()
            os.fsync(written.fileno())
        new.replace(self._path)
