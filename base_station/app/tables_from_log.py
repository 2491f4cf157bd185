"""Tables for a log without a database, made while its replay runs already."""

from __future__ import annotations

from collections.abc import Callable

from base_station.app.factories import Announce, note_segments
from base_station.app.offline_log import OfflineLog
from base_station.replay.processes import jobs
from base_station.replay.processes.projection_process import ProjectionProcess
from base_station.replay.processes.server import ReplayProcesses
from shared.coded_text import coded, text_of_error
from shared.errors import MusterError, StoreError
from shared.worker import UNTIL_WOKEN, Worker


class TablesFromLog:
    """``ProjectedTables`` that are made while it is entered.  Until they are complete, reading is
    refused, as a part of a list would be taken for all of it.
    """

    def __init__(self, offline_log: OfflineLog, announce: Announce) -> None:
        self._offline_log, self._announce = offline_log, announce
        self._processes = ReplayProcesses()
        self._process = ProjectionProcess(self._processes)
        self._is_complete = False
        self._problem = ""
        self._worker = Worker(
            "tables from log", self._make, "the tables of this log are not complete"
        )

    def __enter__(self) -> TablesFromLog:
        self._worker.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._worker.stop()
        self._process.close()
        self._processes.close()
        self._worker.join()  # nothing writes to the tables any more

    def flush(self) -> bool:
        return self._is_complete

    def flush_soon(self) -> Callable[[], bool]:
        """As in ``ProjectedTables``. Raises StoreError if the tables are not complete."""
        if self._problem:
            raise StoreError(
                coded(
                    "tables-not-made",
                    "The lists of this incident could not be made from its log: {reason}",
                    reason=self._problem,
                )
            )
        if not self._is_complete:
            raise StoreError(
                coded(
                    "tables-being-made",
                    "The lists of this incident are being made from its log, as it came without a "
                    "database; the replay runs meanwhile. Try again in a minute.",
                )
            )
        return self.flush

    def flush_actions_soon(self) -> Callable[[], bool]:
        """Return at once: actions are complete from the beginning (``OfflineLog.lacks_tables``)."""
        return lambda: True

    def _make(self) -> float:
        given = self._offline_log
        job = jobs.CatchUpJob(
            log=str(given.folder.log),
            checkpoints=str(given.scratch / "checkpoints"),
            database=str(given.database),
            since_ns=0,
        )
        try:
            if self._process.run(job):
                note_segments(given.store, given.folder.log)
                self._is_complete = True
                self._announce("the lists of the incident are made from its log: all can be read")
        except MusterError as error:
            if not self._worker.stopping.is_set():
                self._problem = text_of_error(error)
                self._announce(f"the lists of the incident are not made: {error}")
        return UNTIL_WOKEN
