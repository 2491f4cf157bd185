"""A real station that a test may kill and start again where it was."""

from __future__ import annotations

from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from tests.rig.first_login import first_login
from tests.rig.station_command import Command
from tests.rig.station_process import free_port


class StationProcess:
    """``muster base serve`` on free ports, with its data in a folder.

    With the id of an incident it is ``muster base replay`` on a folder of another station.
    """

    def __init__(self, data: Path, replayed: str | None = None, *, enrols: bool = False) -> None:
        """``enrols``: it has an authority of its own, and its bus listens to enrolled units."""
        self.data = data
        self.bus = f"{'tls' if enrols else 'tcp'}/127.0.0.1:{free_port()}"
        if enrols:
            data.mkdir()
            PkiFolder(data).create("Test", hosts=[], connect=[self.bus])
        self.http = f"127.0.0.1:{free_port()}"
        self.address = f"http://{self.http}"
        what = ("replay", replayed) if replayed else ("serve", "--listen", self.bus)
        self._arguments = (*what, "--data", str(data), "--http", self.http)
        self._output = data.with_suffix(f".{what[0]}.txt")
        self._command: Command | None = None

    def start(self) -> None:
        """Returns when it is ready."""
        self._command = Command(self._output, *self._arguments)
        self._command.wait_ready()

    def kill(self) -> None:
        """As a power cut would."""
        assert self._command is not None
        self._command.kill()

    def stop(self) -> None:
        """In order; nothing happens where it does not run."""
        if self._command is not None and self._command.runs():
            self._command.stop()

    def login(self) -> tuple[str, str]:
        """Name and password that the station made at its first start, changed as it asks."""
        return first_login(self.address, self.data / "first-login.txt")
