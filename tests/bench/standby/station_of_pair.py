"""One of two real stations, as a process: started, asked, killed and read."""

from __future__ import annotations

import signal
import urllib.error
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from base_station.core.log_position import is_event
from shared.channels import Direction, parse_key
from shared.codec import header_of
from shared.errors import StoreError, UnknownChannelError
from shared.mcap_log import read_log
from tests.rig import processes
from tests.rig.console_client import Api
from tests.rig.lossy_link import Namespace
from tests.rig.program import Launch, Program, end_hard, launch_installed

T = TypeVar("T")
MessageId = tuple[str, int, int]  # unit, boot id, sequence number

_STOP_S = 30.0
_ELSEWHERE = 503
_NOT_YET = (urllib.error.URLError, ConnectionError, TimeoutError, StoreError)


class Logged(NamedTuple):
    """Contents of one station's log."""

    messages: Counter[MessageId]  # how often each of the units' messages is there
    events: list[tuple[int, str, bytes]]

    @property
    def duplicates(self) -> int:
        return sum(self.messages.values()) - len(self.messages)


@dataclass
class Place:
    """Host of a station or a unit."""

    address: str = "127.0.0.1"
    namespace: Namespace | None = None

    def call(self, work: Callable[[], T]) -> T:
        return work() if self.namespace is None else self.namespace.call(work)


@dataclass(eq=False)
class Station:
    """One of the two; ``start`` it as often as wanted."""

    name: str
    place: Place
    folder: Path  # of the station's data, its settings and what it prints
    bus_port: int
    http_port: int
    login: Callable[[], tuple[str, str]]
    launch: Launch = launch_installed
    process: Program | None = field(default=None, init=False)
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
        settings = str(self.folder / f"{self.name}.toml")
        output = self.folder / f"{self.name}.txt"
        arguments = ("serve", "--config", settings)
        self.process = self.launch("base_station", arguments, output, self.place.namespace)
        self._api = None

    def kill(self) -> None:
        """At once, as a power cut does."""
        if self.process is not None:
            end_hard(self.process)

    def cpu_s(self) -> float:
        """Processor time of the running program, children included; 0 while it does not run."""
        if self.process is None or self.process.poll() is not None:
            return 0.0
        return processes.cpu_s(self.process.pid)

    def stop(self) -> int:
        assert self.process is not None
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(_STOP_S)

    def get(self, path: str) -> Any:
        return self.place.call(lambda: self.logged_in().get(path))

    def post(self, path: str, body: dict[str, Any]) -> Any:
        return self.place.call(lambda: self.logged_in().post(path, body))

    def refuses(self, path: str, body: dict[str, Any]) -> bool:
        """True if the station refuses changes."""
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

    def output(self) -> str:
        return (self.folder / f"{self.name}.txt").read_text(errors="replace")

    def logged(self) -> Logged:
        messages: Counter[MessageId] = Counter()
        events = []
        for t_ns, key, payload in read_log(self.data / "log"):
            if is_event(key):
                events.append((t_ns, key, payload))
            try:
                unit_id, channel = parse_key(key)
            except UnknownChannelError:
                continue
            # Of the header alone: tests look at the log of tens of thousands again and again.
            if channel.direction is Direction.UP and (header := header_of(payload)) is not None:
                messages[unit_id, header.boot_id, header.seq] += 1
        return Logged(messages, events)

    def logged_in(self) -> Api:
        if self._api is None:
            self._api = Api(self.url, *self.login())
        return self._api
