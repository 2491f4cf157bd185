"""Past incidents from the archive of the department: each is shown by a process of its own with a
login of its own, as by ``muster base replay --archive``.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Lock, Timer

from base_station.config import HttpConfig, host_and_port
from base_station.department.answers import StartedReplay
from base_station.department.config import DepartmentArchiveConfig
from shared.coded_text import coded
from shared.errors import ArchiveError

_LOGIN = re.compile(r"^login for this replay: (\S+)  password: (\S+)$")
_START_S = 60.0
_END_S = 10.0
_TAIL_LINES = 3  # of its output, where it does not start
_PROGRAM = "base_station.department.replay_program"


@dataclass(frozen=True, slots=True)
class _Running:
    process: subprocess.Popen[str]
    answer: StartedReplay


class ArchiveReplays:
    """Replays that run.  Thread-safe.  ``close`` ends all of them."""

    def __init__(self, config: DepartmentArchiveConfig, http: HttpConfig) -> None:
        self._config, self._http = config, http
        self._lock = Lock()
        self._running: dict[tuple[str, str], _Running] = {}  # the latest request is last

    def open(self, station: str, incident_id: str) -> StartedReplay:
        """Open a replay, or return the one that runs already; beyond the limit the oldest ends.

        Raises ArchiveError with the reason if it does not start.
        """
        key = station, incident_id
        with self._lock:
            self._forget_ended()
            running = self._running.pop(key, None)
            if running is None:
                running = self._start(station, incident_id, self._free_port())
            self._running[key] = running
        return running.answer

    def close(self) -> None:
        with self._lock:
            for one in self._running.values():
                _end(one.process)
            self._running.clear()

    def _forget_ended(self) -> None:
        for key, one in list(self._running.items()):
            if one.process.poll() is not None:
                _end(self._running.pop(key).process)

    def _free_port(self) -> int:
        if len(self._running) >= self._config.replays:
            _end(self._running.pop(next(iter(self._running))).process)
        taken = {one.answer.port for one in self._running.values()}
        first_port = self._config.first_port
        ports = range(first_port, first_port + self._config.replays)
        return next(one for one in ports if one not in taken)

    def _start(self, station: str, incident_id: str, port: int) -> _Running:
        host, _ = host_and_port(self._http.listen)
        place = f"{self._config.location.rstrip('/')}/{station}"
        process = subprocess.Popen(
            [sys.executable, "-m", _PROGRAM, incident_id, place, f"{host}:{port}", *self._tls()],
            stdin=subprocess.PIPE,  # it ends with it, and so with this program
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        username, password = _login_of(process, lambda: _end(process))
        return _Running(process, StartedReplay(port, username, password))

    def _tls(self) -> tuple[str, ...]:
        """Files of this page's certificate, which is for the same machine."""
        files: tuple[Path | None, ...] = self._http.certificate, self._http.private_key
        return tuple(str(one) for one in files if one is not None)


def _login_of(process: subprocess.Popen[str], give_up: Callable[[], None]) -> tuple[str, str]:
    """User and password, once browsers can connect.  Raises ArchiveError."""
    assert process.stdout is not None
    login = ("", "")
    printed: list[str] = []
    patience = Timer(_START_S, process.kill)
    patience.start()
    try:
        for line in process.stdout:
            if found := _LOGIN.match(line.rstrip()):
                login = found[1], found[2]
            elif line.startswith("ready "):
                return login
            else:
                printed.append(line.strip())
    finally:
        patience.cancel()
    give_up()
    raise ArchiveError(
        coded(
            "archive-replay-not-started",
            "the replay did not start: {reason}",
            reason=" ".join(printed[-_TAIL_LINES:])
            or coded("archive-replay-no-reason", "it gave no reason"),
        )
    )


def _end(process: subprocess.Popen[str]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    try:
        process.wait(_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
