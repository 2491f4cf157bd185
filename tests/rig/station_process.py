"""A real station as a process of its own, on free ports and a folder of its own."""

from __future__ import annotations

import re
import secrets
import signal
import socket
import sqlite3
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from functools import cached_property
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from base_station.security.pki.folder import PkiFolder
from base_station.storage.data_folder import DataFolder
from shared.bus_zenoh import UnitEndpoint
from shared.channels import parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.mcap_log import read_log
from shared.messages import STATION_ID, FusedPosition
from shared.tls import TlsIdentity
from tests.rig import processes
from tests.rig.console_client import Api
from tests.rig.first_login import first_login
from tests.rig.lossy_link import Namespace
from tests.rig.program import Launch, Program, end_hard, launch_installed

_OUTPUT = "station.txt"
_READY = re.compile(r"^ready (http\S+)\n", re.MULTILINE)
_POLL_INTERVAL_S = 0.02
_START_TIMEOUT_S = 180.0  # a machine that does ten other things at once takes a minute
_STOP_TIMEOUT_S = 30.0


PlainTcp = Annotated[bool, typer.Option("--plain", help="Over plain TCP instead of mutual TLS.")]


class RunRecords(NamedTuple):
    """Contents of log and database after the run."""

    from_units: int  # messages, each counted once
    repeated: int
    damage: int
    track_points_due: int  # of the log's fused positions, one a second and unit
    track_points: int  # in the database


class StationProcess:
    def __init__(self, data: Path, program: Program, url: str) -> None:
        self._data = DataFolder(data)
        self._program = program
        self.url = url
        self._cpu_s = 0.0
        self._since = 0.0

    @cached_property
    def api(self) -> Api:
        return Api(self.url, *first_login(self.url, self._data.first_login))

    def begin_measuring(self) -> None:
        self._cpu_s, self._since = self.cpu_s(), time.perf_counter()

    def cpu_share(self) -> float:
        """Share of one core since ``begin_measuring``, children included."""
        return (self.cpu_s() - self._cpu_s) / (time.perf_counter() - self._since)

    def memory_mb(self) -> float:
        return processes.memory_mb(self.pid)

    @property
    def pid(self) -> int:
        return self._program.pid

    def stop(self) -> int:
        """In order; its exit code."""
        self._program.send_signal(signal.SIGINT)
        return self._program.wait(_STOP_TIMEOUT_S)

    @property
    def log(self) -> Path:
        return self._data.log

    def recorded(self) -> RunRecords:
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
        return RunRecords(len(messages), repeated, len(damage), len(seconds), int(points))

    def cpu_s(self) -> float:
        """Spent since it began, children included."""
        return processes.cpu_s(self.pid)


class Membership:
    """Address of the station's bus, and the certificate of each unit, if any."""

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
    network: Namespace | None = None,
    patience_s: float = _START_TIMEOUT_S,
    launch: Launch = launch_installed,
    settings: Path | None = None,
    before: str = "",
) -> Iterator[StationProcess]:
    """Runs ``muster base serve``; ended hard where ``stop`` was not called.  ``before``: statements
    that Python executes first.
    """
    arguments = ["serve", "--data", str(data), "--listen", bus_address]
    arguments += ["--http", f"127.0.0.1:{free_port()}"]
    if settings is not None:
        arguments += ["--config", str(settings)]
    output = data / _OUTPUT
    output.touch()
    printed_before = output.stat().st_size
    program = launch("base_station", arguments, output, network, before)
    try:
        yield StationProcess(data, program, _ready_url(program, output, printed_before, patience_s))
    finally:
        end_hard(program)


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


def _ready_url(program: Program, output: Path, before: int, patience_s: float) -> str:
    """As it is printed behind the first ``before`` bytes, which are of former runs."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline:
        ended = program.poll() is not None
        printed = output.read_bytes()[before:].decode(errors="replace")
        ready = _READY.search(printed)
        if ready is not None:
            return ready[1]
        if ended:
            break
        time.sleep(_POLL_INTERVAL_S)
    raise StoreError(f"the station to be measured did not start: {printed[-2000:]}")
