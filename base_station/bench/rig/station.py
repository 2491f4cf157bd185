"""A real station as a process of its own, on free ports and a folder of its own."""

from __future__ import annotations

import secrets
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from functools import cached_property
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from base_station.bench.rig import processes
from base_station.bench.rig.console import Api
from base_station.pki.folder import PkiFolder
from base_station.storage.data_folder import DataFolder
from shared.bus_zenoh import UnitEndpoint
from shared.channels import parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.mcap_log import read_log
from shared.messages import STATION_ID, FusedPosition
from shared.tls import TlsIdentity

_SAID = "station.err"
_START_TIMEOUT_S = 60.0
_STOP_TIMEOUT_S = 30.0


PlainTcp = Annotated[bool, typer.Option("--plain", help="Over plain TCP instead of mutual TLS.")]


class Recorded(NamedTuple):
    """What the log and the database hold after the run."""

    from_units: int  # messages, each counted once
    repeated: int
    damage: int
    track_points_due: int  # of the log's fused positions, one a second and unit
    track_points: int  # in the database


class StationProcess:
    def __init__(self, data: Path, process: subprocess.Popen[str], patience_s: float) -> None:
        self._data = DataFolder(data)
        self._process = process
        self._cpu_s = 0.0
        self._since = 0.0
        self._url = _ready_url(process, data / _SAID, patience_s)

    @cached_property
    def api(self) -> Api:
        return Api(self._url, *first_login(self._data.first_login))

    def begin_measuring(self) -> None:
        self._cpu_s, self._since = self.cpu_s(), time.perf_counter()

    def cpu_share(self) -> float:
        """Of one core, since ``begin_measuring``, children included."""
        return (self.cpu_s() - self._cpu_s) / (time.perf_counter() - self._since)

    def memory_mb(self) -> float:
        return processes.memory_mb(self.pid)

    @property
    def pid(self) -> int:
        return self._process.pid

    def stop(self) -> int:
        """In order; its exit code."""
        self._process.send_signal(signal.SIGINT)
        return self._process.wait(_STOP_TIMEOUT_S)

    @property
    def log(self) -> Path:
        return self._data.log

    def recorded(self) -> Recorded:
        """Read after ``stop``."""
        messages: Counter[tuple[str, int, int]] = Counter()
        seconds: set[tuple[str, int]] = set()
        damage: list[str] = []
        for _, key, payload in read_log(self._data.log, on_damage=damage.append):
            try:
                unit_id, channel = parse_key(key)
                message = decode(channel, payload)
            except WireError as error:
                damage.append(str(error))
                continue
            if isinstance(message, FusedPosition):
                seconds.add((message.unit_id, message.t_meas_ns // NS_PER_S))
            elif unit_id != STATION_ID:
                messages[unit_id, message.header.boot_id, message.header.seq] += 1
        with closing(sqlite3.connect(self._data.database)) as database:
            [(points,)] = database.execute("SELECT count(*) FROM tracks").fetchall()
        repeated = sum(messages.values()) - len(messages)
        return Recorded(len(messages), repeated, len(damage), len(seconds), int(points))

    def cpu_s(self) -> float:
        """Spent since it began, children included."""
        return processes.cpu_s(self.pid)


class Membership:
    """Where the station's bus is and with what each unit gets in: its certificate, or nothing."""

    def __init__(self, data: Path, unit_ids: Sequence[str], *, plain: bool) -> None:
        self.address = f"{'tcp' if plain else 'tls'}/127.0.0.1:{free_port()}"
        self._identities: dict[str, TlsIdentity] = {}
        if not plain:
            authority = PkiFolder(data)
            authority.create("bench", hosts=[], connect=[self.address])
            self._identities = {one: authority.enroll(one).identity for one in unit_ids}

    def endpoint_of(self, unit_id: str) -> UnitEndpoint:
        return UnitEndpoint((self.address,), self._identities.get(unit_id))


@contextmanager
def station_process(
    data: Path,
    bus_address: str,
    inside: Sequence[str] = (),
    patience_s: float = _START_TIMEOUT_S,
) -> Iterator[StationProcess]:
    """Runs ``muster base serve``; ended hard where ``stop`` was not called.

    ``inside``: what to put before the command so that it runs in another network.
    """
    command = "from base_station.cli import app; app()"
    arguments = ["serve", "--data", str(data), "--listen", bus_address]
    arguments += ["--http", f"127.0.0.1:{free_port()}"]
    with (
        (data / _SAID).open("a") as said,
        subprocess.Popen(
            [*inside, sys.executable, "-c", command, *arguments],
            stdout=subprocess.PIPE,
            stderr=said,
            text=True,
        ) as process,
    ):
        try:
            yield StationProcess(data, process, patience_s)
        finally:
            if process.poll() is None:
                process.kill()


def free_port() -> int:
    """Below those that the system gives out, so that nobody is given it before it is used."""
    while True:
        port = secrets.choice(range(12_000, 32_000))
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port


def _ready_url(process: subprocess.Popen[str], said: Path, patience_s: float) -> str:
    assert process.stdout is not None
    deadline = time.monotonic() + patience_s
    for line in process.stdout:
        if "ready http" in line:
            return line.split("ready ", 1)[1].strip()
        if time.monotonic() > deadline:
            break
    raise StoreError(f"the station to be measured did not start: {said.read_text()[-2000:]}")


def first_login(note: Path) -> tuple[str, str]:
    """Name and password, as a station wrote them down when it made them."""
    fields = dict(line.split(": ", 1) for line in note.read_text(encoding="utf-8").splitlines())
    return fields["username"], fields["password"]
