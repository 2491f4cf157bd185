"""Keeps the router's process running for as long as the station does."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from contextlib import ExitStack, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock, Thread
from typing import Self

import msgspec

from base_station.security.router.refusals import RefusalSummary, refusal_problem
from shared.coded_text import coded
from shared.errors import BusError
from shared.worker import Worker
from shared.zenoh_settings import LOCAL_LINK, ClientEndpoint

logger = logging.getLogger(__name__)

READY = "router ready"
FAILED = "router failed: "
_RESTART_AFTER_S = 1.0
_ROUTER_DOWN = coded(
    "router-away", "The bus's router is away and is started again; no unit is linked"
)
_STOP_TIMEOUT_S = 5.0
_MEMORY_FOLDER = "/dev/shm"  # noqa: S108  # a folder of its owner's alone is made in it


class RouterSettings(msgspec.Struct, frozen=True):
    """First line on the router's standard input, as JSON; each line behind it is an order."""

    data: str
    listen: tuple[str, ...]
    links: tuple[str, ...]  # other stations' routers, which it joins
    station: tuple[str, ...]  # where the station itself joins


class BanOrder(msgspec.Struct, frozen=True):
    """Order of the station on the router's standard input, one in a line of JSON."""

    sender_id: str
    seconds: float


def start_loading() -> subprocess.Popen[str]:
    """Start a router's process, which loads its libraries and then waits for its settings.  It ends
    by itself where none come.
    """
    return subprocess.Popen(
        [sys.executable, "-m", "base_station.security.router"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        # A Ctrl-C in the terminal reaches the station alone, which ends the router last.
        start_new_session=True,
    )


class RouterProcess:
    """Starts it, and again when it dies; ``wait_open`` waits until it routes, ``close`` ends it.

    It ends by itself when this process is killed: its standard input does.
    """

    def __init__(
        self,
        data: Path,
        listen: tuple[str, ...],
        links: tuple[str, ...] = (),
        loading: subprocess.Popen[str] | None = None,
    ) -> None:
        """``loading``: the first process, by ``start_loading``."""
        # Its owner's alone, and short: the path of a data folder may be too long for a socket.
        self._folder = _folder_in_memory()
        own = f"{LOCAL_LINK}/{self._folder.name}/station"
        self.endpoint = ClientEndpoint((own,))  # the station's; no stranger holds it up there
        self._settings = RouterSettings(str(data), listen, links, (own,))
        self._starting = Lock()
        self._refused = RefusalSummary()
        with ExitStack() as undo:
            undo.callback(self._folder.cleanup)
            self._process = self._start_process(loading)
            undo.pop_all()
        self._is_restarting = False
        self._worker = Worker("router", self._keep_running, "the router is not started again")

    def wait_open(self) -> Self:
        """Gives itself.  Raises BusError with the router's own sentence when it cannot open."""
        try:
            self._require_open(self._process)
        except BusError:
            self._folder.cleanup()
            raise
        self._worker.start()
        return self

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def is_open(self) -> bool:
        return self._process.poll() is None

    @property
    def refused(self) -> RefusalSummary:
        """Connections to the bus that were not let in."""
        return self._refused

    def problems(self) -> tuple[str, ...]:
        problem = "" if self.is_open else _ROUTER_DOWN
        return tuple(filter(None, (refusal_problem(self._refused), problem)))

    def ban(self, sender_id: str, seconds: float) -> None:
        """Ends the links of ``sender_id``, and refuses new ones for a while.

        A router that has just ended does not receive it; there are no links then.
        """
        line = msgspec.json.encode(BanOrder(sender_id, seconds)).decode()
        with self._starting, suppress(OSError, ValueError):
            assert self._process.stdin is not None
            print(line, file=self._process.stdin, flush=True)

    def close(self) -> None:
        with self._starting:
            self._worker.stop()
        _end(self._process)
        self._worker.join()
        self._folder.cleanup()

    def _keep_running(self) -> float:
        """Wait for the end of the process, and start it again."""
        code = self._process.wait()
        if self._worker.stopping.is_set():
            return 0.0
        if not self._is_restarting:
            self._is_restarting = True
            logger.error("the router ended with code %d; starting it again", code)
            _close_pipes(self._process)
        self._is_restarting = not self._restart()
        return _RESTART_AFTER_S if self._is_restarting else 0.0

    def _restart(self) -> bool:
        with self._starting:
            if self._worker.stopping.is_set():
                return False
            try:
                self._process = self._start_process()
                self._require_open(self._process)
            except BusError as error:
                logger.error("%s; trying again", error)
                return False
            return True

    def _start_process(self, loading: subprocess.Popen[str] | None = None) -> subprocess.Popen[str]:
        process = loading or start_loading()
        assert process.stdin is not None
        with suppress(OSError):  # it has ended, as is found when it is waited for
            # Not print: it would try to write an unwritten line again as the pipe is closed.
            os.write(process.stdin.fileno(), msgspec.json.encode(self._settings) + b"\n")
        return process

    def _require_open(self, process: subprocess.Popen[str]) -> None:
        """Waits for it.  Raises BusError with its own sentence where it ends before that."""
        assert process.stdout is not None
        line = process.stdout.readline().rstrip("\n")
        if line == READY:
            self._refused = RefusalSummary()
            Thread(
                target=self._read_messages, args=(process,), name="router-words", daemon=True
            ).start()
            return
        _end(process)
        raise BusError(
            line.removeprefix(FAILED) or "the bus's router ended before it was open; see its log"
        )

    def _read_messages(self, process: subprocess.Popen[str]) -> None:
        """Reads messages of the router, until it ends."""
        assert process.stdout is not None
        with suppress(ValueError):  # closed meanwhile
            for line in process.stdout:
                self._refused = msgspec.json.decode(line, type=RefusalSummary)


def _folder_in_memory() -> TemporaryDirectory[str]:
    """A full or read-only disk keeps no station from its start."""
    folder = _MEMORY_FOLDER if os.access(_MEMORY_FOLDER, os.W_OK | os.X_OK) else None
    return TemporaryDirectory(prefix="muster-router-", dir=folder, ignore_cleanup_errors=True)


def _end(process: subprocess.Popen[str]) -> None:
    _close_pipes(process)
    try:
        process.wait(_STOP_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _close_pipes(process: subprocess.Popen[str]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
