"""Starts processes that look at the past, each a copy of one that has loaded the program already.

Loading takes seconds and 100 MB and more; copies of the loaded one begin at once and share that
memory.  The loaded one has no thread, so that it can be copied at any time.  It is there while it
is used, and ends when this program does, however that ends: the socket between them closes.
"""

from __future__ import annotations

import logging
import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from threading import Lock

from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import Job
from shared.coded_text import coded
from shared.errors import StoreError

STOPPING = coded("station-ends", "the station is stopping")

IDLE_S = 600.0  # after the last use it is ended: its memory may be wanted
_NUMERICS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
_ONE_THREAD = dict.fromkeys(_NUMERICS, "1")  # the other cores are for the live station
_log = logging.getLogger(__name__)


class ReplayProcesses:
    """From any thread."""

    def __init__(self, monotonic_s: Callable[[], float] = time.monotonic) -> None:
        self._monotonic_s = monotonic_s
        self._lock = Lock()
        self._server: subprocess.Popen[bytes] | None = None
        self._control: socket.socket | None = None
        self._used_s = 0.0
        self._closed = False

    def __enter__(self) -> ReplayProcesses:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def start(self, job: Job) -> FrameChannel:
        """A process that does this; it ends when the line to it is closed.

        Raises StoreError where no process can be started.
        """
        with self._lock:
            if self._closed:
                raise StoreError(STOPPING)
            self._used_s = self._monotonic_s()
            try:
                ours = self._new_process()
            except OSError as first:  # it was ended meanwhile: a new one
                _log.warning("the process that others are copied from has ended: %s", first)
                self._end_server()
                try:
                    ours = self._new_process()
                except OSError as error:
                    raise StoreError(
                        coded("no-process", "no process can be started: {error}", error=str(error))
                    ) from error
        line = FrameChannel(ours)
        line.send(job)
        return line

    def end_idle(self) -> None:
        """Called now and then; copies that are at work go on."""
        with self._lock:
            if self._server is not None and self._monotonic_s() - self._used_s > IDLE_S:
                self._end_server()

    def close(self) -> None:
        with self._lock:
            self._closed = True
            self._end_server()

    @property
    def pid(self) -> int | None:
        """Id of the process that others are copied from; None: there is none."""
        with self._lock:
            return None if self._server is None else self._server.pid

    def _new_process(self) -> socket.socket:
        if self._control is None:
            self._start_server()
        assert self._control is not None
        ours, theirs = socket.socketpair()
        with theirs:
            try:
                socket.send_fds(self._control, [b"\0"], [theirs.fileno()])
            except OSError:
                ours.close()
                raise
        return ours

    def _start_server(self) -> None:
        self._control, theirs = socket.socketpair()
        command = [sys.executable, "-m", "base_station.app.worker_process", str(theirs.fileno())]
        with theirs:
            self._server = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                pass_fds=(theirs.fileno(),),
                env={**os.environ, **_ONE_THREAD},
            )

    def _end_server(self) -> None:
        if self._control is not None:
            self._control.close()
            self._control = None
        if self._server is not None:
            self._server.kill()  # it may be amid loading, and holds nothing
            self._server.wait()
            self._server = None
