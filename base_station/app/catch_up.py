"""Brings decisions made while the tables' server was away into the tables, from the log.

It is stepped in a process of its own: that takes minutes after an hour of many units.
"""

from __future__ import annotations

from collections.abc import Callable

from base_station.replay.processes import jobs
from base_station.replay.processes.projection_process import ProjectionProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.projection import SqlProjection
from shared.worker import Worker

EVERY_S = 2.0


class CatchUp:
    """Worker that runs while it is entered."""

    def __init__(
        self,
        folder: DataFolder,
        processes: ReplayProcesses,
        projection: SqlProjection,
        prepare: Callable[[], object],
    ) -> None:
        """``prepare`` flushes recorded data to disk."""
        self._folder = folder
        self._process = ProjectionProcess(processes)
        self._projection, self._prepare = projection, prepare
        self._worker = Worker.periodic(
            "catching up",
            EVERY_S,
            lambda _: self._run(),
            "what was decided while the database was away is not in it yet",
        )

    def __enter__(self) -> CatchUp:
        self._worker.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._process.close()
        self._worker.close()

    def _run(self) -> None:
        """Project missing records, if there are any.  Raises StoreError; the worker tries again."""
        missing = self._projection.missing()
        if missing is None:
            return
        self._prepare()
        job = jobs.CatchUpJob(
            log=str(self._folder.log),
            checkpoints=str(self._folder.checkpoints),
            database=str(self._folder.database),
            since_ns=missing.since_ns,
        )
        if self._process.run(job):
            self._projection.note_caught_up(missing)
