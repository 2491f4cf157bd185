"""Projection of a log into its tables, in a process of its own."""

from __future__ import annotations

from threading import Lock

from base_station.replay.processes import frame_channel, jobs, wire
from base_station.replay.processes.server import ReplayProcesses
from shared.coded_text import coded
from shared.errors import StoreError


class ProjectionProcess:
    """``run`` in one thread; ``close`` from any."""

    def __init__(self, processes: ReplayProcesses) -> None:
        self._processes = processes
        self._lock = Lock()  # guards the fields below
        self._line: frame_channel.FrameChannel | None = None
        self._closed = False

    def run(self, job: jobs.CatchUpJob) -> bool:
        """Wait until the log is projected; return False where it is closed before that began.

        Raises StoreError, also where it is closed meanwhile.
        """
        with self._lock:
            if self._closed:
                return False
            self._line = line = self._processes.start(job)
        try:
            _wait_for(line)
        finally:
            with self._lock:
                self._line = None
            line.close()
        return True

    def close(self) -> None:
        """End a process that runs; ``run`` returns when it has ended.  No other is started."""
        with self._lock:
            self._closed = True
            if self._line is not None:
                self._line.stop_sending()


def _wait_for(line: frame_channel.FrameChannel) -> None:
    while (encoded := line.receive()) is not None:
        match wire.read_catch_up(encoded):
            case wire.CaughtUp():
                return
            case wire.Failure() as failure:
                raise failure.error()
            case wire.Damage():
                pass  # the integrity check finds it, too
    raise StoreError(coded("projection-ended", "the process that projects the log has ended"))
