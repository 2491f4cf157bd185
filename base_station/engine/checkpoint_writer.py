"""Checkpoint writer in a thread of its own: flushing the log, packing the state and writing it take
longer than a position may wait.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor

from base_station.engine.health_monitor import HealthMonitor
from base_station.engine.ports import Log
from base_station.storage.checkpoints import Checkpoints
from shared.coded_text import coded

PART = "checkpoint"


class CheckpointWriter:
    """Writer of checkpoints for one thread, which waits in ``finish`` only."""

    def __init__(self, log: Log, checkpoints: Checkpoints, health: HealthMonitor) -> None:
        self._log = log
        self._checkpoints = checkpoints
        self._health = health
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="checkpoints")
        self._under_way: Future[None] | None = None

    @property
    def is_under_way(self) -> bool:
        return self._under_way is not None and not self._under_way.done()

    def begin(self, log_position: tuple[int, int], state: bytes) -> None:
        """Begin to write ``state``, as it is at ``log_position`` of the log."""
        self.finish()
        self._under_way = self._worker.submit(self._save, log_position, state)

    def check(self) -> None:
        """Report the result of the last checkpoint, once it is finished."""
        if not self.is_under_way:
            self.finish()

    def finish(self) -> None:
        """Wait until the checkpoint is on disk or its failure is reported."""
        saved, self._under_way = self._under_way, None
        if saved is None:
            return
        try:
            saved.result()
        except OSError as error:
            text = coded(
                "checkpoint-refused",
                "The live state cannot be saved ({error}): free the disk",
                error=str(error),
            )
            self._health.report(PART, text)
        except Exception as error:  # noqa: BLE001  # the log has everything that matters
            self._health.report_bug(PART, error)

    def _save(self, log_position: tuple[int, int], state: bytes) -> None:
        if self._log.flush():  # it must not have events that the log would lose in a crash
            self._checkpoints.save(*log_position, state)
