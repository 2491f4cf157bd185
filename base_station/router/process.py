"""Keeps the router's process running for as long as the station does."""

from __future__ import annotations

import logging
import subprocess
import sys
from pathlib import Path
from threading import Event, Lock, Thread

from shared.errors import BusError

logger = logging.getLogger(__name__)

READY = "router ready"
FAILED = "router failed: "
LINKS = "--links"  # between where it listens and whom it joins
_RESTART_AFTER_S = 1.0
_PATIENCE_S = 5.0


class RouterProcess:
    """Starts it and waits until it routes; starts it again when it dies; ``close`` ends it.

    It ends by itself when this process is killed: its standard input does.
    """

    def __init__(self, data: Path, listen: tuple[str, ...], links: tuple[str, ...] = ()) -> None:
        """Raises BusError with the router's own sentence when it cannot open."""
        endpoints = (*listen, LINKS, *links) if links else listen
        self._command = [sys.executable, "-m", "base_station.router", str(data), *endpoints]
        self._closing = Event()
        self._starting = Lock()
        self._process = self._start()
        self._thread = Thread(target=self._keep_running, name="router", daemon=True)
        self._thread.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def is_open(self) -> bool:
        return self._process.poll() is None

    def close(self) -> None:
        with self._starting:
            self._closing.set()
        _end(self._process)
        self._thread.join()

    def _keep_running(self) -> None:
        while True:
            code = self._process.wait()
            if self._closing.is_set():
                return
            logger.error("the router ended with code %d; starting it again", code)
            _close_pipes(self._process)
            while not self._started_again():
                if self._closing.wait(_RESTART_AFTER_S):
                    return

    def _started_again(self) -> bool:
        with self._starting:
            if self._closing.is_set():
                return False
            try:
                self._process = self._start()
            except BusError as error:
                logger.error("%s; trying again", error)
                return False
            return True

    def _start(self) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            self._command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            # A Ctrl-C in the terminal reaches the station alone, which ends the router last.
            start_new_session=True,
        )
        assert process.stdout is not None
        line = process.stdout.readline().rstrip("\n")
        if line == READY:
            return process
        _end(process)
        raise BusError(
            line.removeprefix(FAILED) or "the bus's router ended before it was open; see its log"
        )


def _end(process: subprocess.Popen[str]) -> None:
    _close_pipes(process)
    try:
        process.wait(_PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _close_pipes(process: subprocess.Popen[str]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
