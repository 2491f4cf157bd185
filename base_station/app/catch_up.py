"""Brings decisions made while the tables' server was away into the tables, from the log.

It is stepped in a process of its own: that takes minutes after an hour of many units.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

from base_station.replay.processes import wire
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.projection import SqlProjection
from shared.errors import StoreError
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
        """``prepare``: brings recorded data to the disk."""
        self._folder, self._processes = folder, processes
        self._projection, self._prepare = projection, prepare
        self._lock = Lock()  # guards the fields below
        self._line: wire.FrameChannel | None = None
        self._closed = False
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
        with self._lock:
            self._closed = True
            if self._line is not None:
                self._line.hang_up()
        self._worker.close()

    def _run(self) -> None:
        """Project missing records, if there are any.  Raises StoreError; the worker tries again."""
        missing = self._projection.missing()
        if missing is None:
            return
        self._prepare()
        line = self._begin(missing.since_ns)
        if line is None:
            return
        try:
            self._wait_for(line)
        finally:
            with self._lock:
                self._line = None
            line.hang_up()
            line.close()
        self._projection.note_caught_up(missing)

    def _begin(self, since_ns: int) -> wire.FrameChannel | None:
        """None where the station is stopping."""
        job = wire.CatchUpJob(
            log=str(self._folder.log),
            checkpoints=str(self._folder.checkpoints),
            database=str(self._folder.database),
            since_ns=since_ns,
        )
        with self._lock:
            self._line = None if self._closed else self._processes.start(job)
            return self._line

    def _wait_for(self, line: wire.FrameChannel) -> None:
        while (encoded := line.receive()) is not None:
            match wire.read_catch_up(encoded):
                case wire.CaughtUp():
                    return
                case wire.Failure() as failure:
                    raise failure.error()
                case wire.Damage():
                    pass  # the integrity check finds it, too
        raise StoreError("the process that projects the log has ended")
