"""A real station as a process of its own, which a test may kill and start again."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

PATIENCE_S = 60.0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


class StationProcess:
    """``muster base serve`` on free ports, with its data in a folder.

    With the id of an incident it is ``muster base replay`` on a folder of another station.
    """

    def __init__(self, data: Path, replayed: str | None = None) -> None:
        self.data = data
        self._replayed = replayed
        self._output = data.with_suffix(".replay.txt" if replayed else ".txt")
        self._process: subprocess.Popen[bytes] | None = None
        self.bus = f"tcp/127.0.0.1:{free_port()}"
        self.http = f"127.0.0.1:{free_port()}"
        self.address = f"http://{self.http}"

    def start(self) -> None:
        """Returns when it is ready."""
        what = ("replay", self._replayed) if self._replayed else ("serve", "--listen", self.bus)
        flags = ("--data", str(self.data), "--http", self.http)
        with self._output.open("wb") as output:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "shared.command_line", "base", *what, *flags],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        deadline = time.monotonic() + PATIENCE_S
        while not any(line.startswith("ready") for line in self.said().splitlines()):
            assert self._process.poll() is None, f"the station ended:\n{self.said()}"
            assert time.monotonic() < deadline, f"the station is not ready:\n{self.said()}"
            time.sleep(0.05)

    def said(self) -> str:
        return self._output.read_text(errors="replace")

    def kill(self) -> None:
        """As a power cut would."""
        assert self._process is not None
        self._process.kill()
        self._process.wait()

    def stop(self) -> None:
        if self._process is None or self._process.poll() is not None:
            return
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(20.0)
        except subprocess.TimeoutExpired:
            self.kill()

    def login(self) -> tuple[str, str]:
        """Name and password that the station made at its first start."""
        text = (self.data / "first-login.txt").read_text()
        entries = dict(line.split(": ", 1) for line in text.splitlines())
        return entries["username"], entries["password"]
