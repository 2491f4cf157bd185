"""``muster base ...`` and ``muster edge run`` as processes, and units that speak to a station."""

from __future__ import annotations

import importlib
import io
import os
import signal
import sys
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import httpx

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import channel_of
from shared.clock import SystemClock
from shared.codec import encode
from shared.envelope import Stamper
from shared.errors import MusterError
from shared.messages import Message
from tests.set_clock import go_by_machine_clock
from tests.waiting import PATIENCE_S, until

# Each command forks off a process that has loaded the program: hundreds are started, and to load
# it takes a core three seconds. The demo and the benches start it as it is installed.
_LOADED = get_context("forkserver")
_LOADED.set_forkserver_preload(
    [
        __name__,
        *("base_station.cli", "base_station.app.live", "base_station.app.replay"),
        *("edge.cli", "edge.app"),
    ]
)


def _run(
    package: str, arguments: tuple[str, ...], stdin: str, output: Path, environ: dict[str, str]
) -> None:
    """As ``shared.command_line.main`` does it, without the entry points of an installed program."""
    sys.stdin = io.StringIO(stdin)
    with output.open("ab") as written:
        os.dup2(written.fileno(), 1)
        os.dup2(written.fileno(), 2)
    os.environ.clear()
    os.environ.update(environ)
    go_by_machine_clock()
    sys.argv = [package, *arguments]
    try:
        importlib.import_module(f"{package}.cli").app()
    except MusterError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


class Command:
    """One run of ``muster base``; it is killed where a test leaves it running."""

    package = "base_station"

    def __init__(self, output: Path, *arguments: str, stdin: str = "") -> None:
        self._output = output
        output.write_bytes(b"")
        how = (self.package, arguments, stdin, output, dict(os.environ))
        self._process = _LOADED.Process(target=_run, args=how, daemon=True)
        self._process.start()

    def __enter__(self) -> Command:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    @property
    def pid(self) -> int:
        assert self._process.pid is not None
        return self._process.pid

    def runs(self) -> bool:
        return self._process.is_alive()

    def said(self) -> str:
        return self._output.read_text(errors="replace")

    def wait_ready(self) -> str:
        """The address of the console."""
        until(
            lambda: "\nready " in f"\n{self.said()}" or not self.runs(),
            "the station is ready or has ended",
        )
        assert self.runs(), f"the station ended:\n{self.said()}"
        (line,) = (line for line in self.said().splitlines() if line.startswith("ready "))
        return line.removeprefix("ready ")

    def wait(self) -> int:
        self._process.join(PATIENCE_S)
        assert self._process.exitcode is not None, f"it has not ended:\n{self.said()}"
        return self._process.exitcode

    def stop(self, by: signal.Signals = signal.SIGTERM) -> int:
        os.kill(self.pid, by)
        return self.wait()

    def kill(self) -> None:
        self._process.kill()
        self._process.join()


class Agent(Command):
    """One run of ``muster edge run``."""

    package = "edge"

    def __init__(self, output: Path, *flags: str) -> None:
        super().__init__(output, "run", *flags)


class Browser:
    """A person at the console."""

    def __init__(self, address: str, data: Path) -> None:
        self.address = address
        self._client = httpx.Client(base_url=f"{address}/api/v1", headers={"Origin": address})
        text = (data / "first-login.txt").read_text()
        credentials = dict(line.split(": ", 1) for line in text.splitlines())
        self.call("POST", "/login", json=credentials)

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._client.close()

    def cookie(self) -> str:
        return "; ".join(f"{name}={value}" for name, value in self._client.cookies.items())

    def call(self, method: str, path: str, **request: Any) -> Any:
        answer = self._client.request(method, path, **request)
        assert answer.is_success, f"{method} {path}: {answer.status_code} {answer.text}"
        return answer.json() if answer.content else None

    def status(self, method: str, path: str, **request: Any) -> int:
        return self._client.request(method, path, **request).status_code


class Unit:
    """A wearable as the bus sees it."""

    def __init__(self, port: int, unit_id: str, boot_id: int = 1) -> None:
        self.bus = ZenohBus(UnitEndpoint((f"tcp/127.0.0.1:{port}",)))
        self.stamper = Stamper(unit_id, boot_id, SystemClock())
        self._heard = False

    def say(self, message: Message) -> None:
        """The first time it waits for the link: what is said without one is gone."""
        channel = channel_of(message)
        key = channel.key(self.stamper.unit_id)
        if not self._heard:
            until(lambda: self.bus.is_heard(key), "a station listens")
            self._heard = True
        self.bus.publish(key, encode(message), channel.qos)

    def close(self) -> None:
        self.bus.close()
