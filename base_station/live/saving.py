"""Saves the live state beside the drive: bringing the log to the disk, packing the state and
writing it take longer than a position may wait.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor

from base_station.live.drive_ports import Log
from base_station.live.self_watch import SelfWatch
from base_station.past.checkpoints import Checkpoints

PART = "checkpoint"


class Saving:
    """All of it is for one thread, which never waits but in ``finish``."""

    def __init__(self, log: Log, checkpoints: Checkpoints, watch: SelfWatch) -> None:
        self._log = log
        self._checkpoints = checkpoints
        self._watch = watch
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="checkpoints")
        self._under_way: Future[None] | None = None

    @property
    def is_under_way(self) -> bool:
        return self._under_way is not None and not self._under_way.done()

    def begin(self, place: tuple[int, int], state: bytes) -> None:
        """``state`` as it is at ``place`` of the log."""
        self.finish()
        self._under_way = self._worker.submit(self._save, place, state)

    def look(self) -> None:
        """Tell what came of the last one, once it is over."""
        if not self.is_under_way:
            self.finish()

    def finish(self) -> None:
        """What was begun is on the disk, or told of."""
        saved, self._under_way = self._under_way, None
        if saved is None:
            return
        try:
            saved.result()
        except OSError as error:
            self._watch.note(PART, f"The live state cannot be saved ({error}): free the disk")
        except Exception as error:  # noqa: BLE001  # the log has everything that matters
            self._watch.failed(PART, error)

    def _save(self, place: tuple[int, int], state: bytes) -> None:
        if self._log.flush():  # it must not know what a crash would take from the log
            self._checkpoints.save(*place, state)
