"""Two real stations and real units as processes, on one loopback or in two namespaces."""

from __future__ import annotations

import json
import signal
import sqlite3
import subprocess
import sys
import time
import urllib.error
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from base_station.bench.console import Api
from base_station.bench.lossy_link import Namespace
from base_station.bench.station import free_port
from base_station.pki.folder import PkiFolder
from base_station.standby.places import is_event
from shared.channels import Direction, parse_key
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.mcap_log import read_log

T = TypeVar("T")
MessageId = tuple[str, int, int]  # unit, boot id, sequence number

_LOOK_EVERY_S = 0.1
_START_S = 90.0
_STOP_S = 30.0
_ELSEWHERE = 503
_NOT_YET = (urllib.error.URLError, ConnectionError, TimeoutError, StoreError)


class Logged(NamedTuple):
    """What one station's log holds."""

    messages: Counter[MessageId]  # how often each of the units' messages is there
    events: list[tuple[int, str, bytes]]

    @property
    def duplicates(self) -> int:
        return sum(self.messages.values()) - len(self.messages)


@dataclass
class Place:
    """Where a station or a unit runs."""

    address: str = "127.0.0.1"
    namespace: Namespace | None = None

    def call(self, work: Callable[[], T]) -> T:
        return work() if self.namespace is None else self.namespace.call(work)

    def inside(self) -> tuple[str, ...]:
        return () if self.namespace is None else self.namespace.inside()


@dataclass(eq=False)
class Station:
    """One of the two; ``start`` it as often as wanted."""

    name: str
    place: Place
    folder: Path  # of the station's data, its settings and what it prints
    bus_port: int
    http_port: int
    login: Callable[[], tuple[str, str]]
    process: subprocess.Popen[bytes] | None = field(default=None, init=False)
    _api: Api | None = field(default=None, init=False)

    @property
    def data(self) -> Path:
        return self.folder / self.name

    @property
    def bus(self) -> str:
        return f"tls/{self.place.address}:{self.bus_port}"

    @property
    def url(self) -> str:
        return f"http://{self.place.address}:{self.http_port}"

    def start(self) -> None:
        command = "from base_station.cli import app; app()"
        settings = str(self.folder / f"{self.name}.toml")
        with (self.folder / f"{self.name}.txt").open("ab") as said:
            self.process = subprocess.Popen(
                [
                    *self.place.inside(),
                    sys.executable,
                    "-c",
                    command,
                    "serve",
                    "--config",
                    settings,
                ],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )
        self._api = None

    def kill(self) -> None:
        """At once, as a power cut does."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()

    def stop(self) -> int:
        assert self.process is not None
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(_STOP_S)

    def get(self, path: str) -> Any:
        return self.place.call(lambda: self._logged_in().get(path))

    def post(self, path: str, body: dict[str, Any]) -> Any:
        return self.place.call(lambda: self._logged_in().post(path, body))

    def refuses(self, path: str, body: dict[str, Any]) -> bool:
        """Whether it says that nothing is to be changed here."""
        try:
            self.post(path, body)
        except urllib.error.HTTPError as error:
            return error.code == _ELSEWHERE
        return False

    def delivered(self, text: str) -> set[str]:
        """The units that have this message."""
        return {
            unit["unit_id"]
            for command in self.get("/commands")
            if command["text"] == text
            for unit in command["units"]
            if unit["received_ms"]
        }

    def standing(self) -> dict[str, Any]:
        """Empty while the station does not answer."""
        try:
            found: dict[str, Any] = self.get("/standby")
        except _NOT_YET:
            self._api = None
            return {}
        return found

    def leads(self) -> bool:
        return self.standing().get("role") == "active"

    def follows(self) -> bool:
        """It is a standby and has everything."""
        standing = self.standing()
        return standing.get("role") == "standby" and bool(standing["in_step"])

    def said(self) -> str:
        return (self.folder / f"{self.name}.txt").read_text(errors="replace")

    def logged(self) -> Logged:
        messages: Counter[MessageId] = Counter()
        events = []
        for t_ns, key, payload in read_log(self.data / "log"):
            if is_event(key):
                events.append((t_ns, key, payload))
            try:
                unit_id, channel = parse_key(key)
                if channel.direction is Direction.UP:
                    header = decode(channel, payload).header
                    messages[unit_id, header.boot_id, header.seq] += 1
            except WireError:
                continue
        return Logged(messages, events)

    def _logged_in(self) -> Api:
        if self._api is None:
            self._api = Api(self.url, *self.login())
        return self._api


class TwoStations:
    """``first`` leads when both start; units know both.  Everything is ended by ``closing``."""

    def __init__(self, folder: Path, places: Sequence[Place], closing_all: ExitStack) -> None:
        self._folder = folder
        self._closing = closing_all
        self.first, self.second = (
            Station(name, place, folder, free_port(), free_port(), self._login)
            for name, place in zip(("first", "second"), places, strict=True)
        )
        self.units: dict[str, subprocess.Popen[bytes]] = {}
        self._pki = PkiFolder(self.first.data)
        self._pki.create("bench", [self.first.place.address], [self.first.bus])
        joining = self._pki.enroll_station("second", [self.second.place.address], self.second.bus)
        PkiFolder(self.second.data).join(joining)
        for one, other in ((self.first, self.second), (self.second, self.first)):
            _write_settings(folder / f"{one.name}.toml", one, other, preferred=one is self.first)
            closing_all.callback(one.kill)

    def start(self) -> None:
        """Both, and wait until the second has what the first has."""
        for one in (self.first, self.second):
            one.start()
        wait_until("the first leads and the second follows", self._both_ready)

    def start_unit(self, unit_id: str, near: Station) -> None:
        """A unit that prefers the router of one station; it sends raw samples, several a second."""
        far = self.second if near is self.first else self.first
        file = self._folder / f"{unit_id}.toml"
        self._pki.enroll(unit_id, connect=(near.bus, far.bus)).write(file)
        agent = "from edge.cli import app; app()"
        flags = ["--enrolment", str(file), "--data", str(self._folder / "units")]
        flags += ["--source", "simulated:search-ground-floor", "--tracker", "none"]
        with (self._folder / f"{unit_id}.txt").open("wb") as said:
            self.units[unit_id] = subprocess.Popen(
                [*near.place.inside(), sys.executable, "-c", agent, "run", *flags],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )
        self._closing.callback(_end, self.units[unit_id])

    def wait_heard(self, station: Station) -> None:
        """And known as ours."""

        def all_heard() -> bool:
            units = station.get("/units")
            heard = {u["unit_id"] for u in units if u["last_heard_ms"] and u["registered"]}
            return heard >= self.units.keys()

        wait_until(f"all units are heard at {station.name}", all_heard)

    def stop_units(self) -> None:
        for process in self.units.values():
            _end(process)

    def both_have(self, said: set[MessageId]) -> bool:
        """Whether these messages are in both logs."""
        return all(said <= one.logged().messages.keys() for one in (self.first, self.second))

    def said(self) -> set[MessageId]:
        """What the units have ever said, by their journals."""
        said = set()
        for unit_id in self.units:
            journal = self._folder / "units" / unit_id / "journal.sqlite"
            with closing(sqlite3.connect(f"file:{journal}?mode=ro", uri=True)) as database:
                rows = database.execute(
                    "SELECT boot_id, seq FROM message JOIN boot ON boot.number = message.boot"
                ).fetchall()
            said |= {(unit_id, int(boot) % 2**64, int(seq)) for boot, seq in rows}
        return said

    def _both_ready(self) -> bool:
        return (self.first.data / "first-login.txt").exists() and (
            self.first.leads() and self.second.follows()
        )

    def _login(self) -> tuple[str, str]:
        """The same at both."""
        for station in (self.first, self.second):
            note = station.data / "first-login.txt"
            if note.exists():
                text = note.read_text(encoding="utf-8")
                fields = dict(line.split(": ", 1) for line in text.splitlines())
                return fields["username"], fields["password"]
        raise StoreError("no station has made a first login yet")


def wait_until(what: str, condition: Callable[[], object], patience_s: float = _START_S) -> float:
    """The seconds that it took.  Raises StoreError where it does not come true."""
    began_s = time.monotonic()
    while not condition():
        if time.monotonic() - began_s > patience_s:
            raise StoreError(f"it did not come true within {patience_s:g} s that {what}")
        time.sleep(_LOOK_EVERY_S)
    return time.monotonic() - began_s


def _write_settings(path: Path, one: Station, other: Station, *, preferred: bool) -> None:
    text = f"""
data = {json.dumps(str(one.data))}
insecure = true  # the console, in a network that nobody else is in
[bus]
listen = [{json.dumps(one.bus)}]
[http]
listen = "{one.place.address}:{one.http_port}"
[standby]
name = "{one.name}"
peer = [{json.dumps(other.bus)}]
url = "{one.url}"
preferred = {json.dumps(preferred)}
"""
    path.write_text(text, encoding="utf-8")


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
