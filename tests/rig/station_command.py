"""``muster base ...`` and ``muster edge run`` as processes, and units that speak to a station."""

from __future__ import annotations

import os
import signal
from http import HTTPStatus
from pathlib import Path
from typing import Any

import httpx

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import channel_of
from shared.clock import SystemClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import Message
from tests.rig.incident_closing import despite
from tests.rig.loaded_program import Invocation, LoadedProgram
from tests.rig.plain_http import NO_AUTHORITIES
from tests.rig.program import end_hard
from tests.rig.waiting import PATIENCE_S, until

_CLOSING_TRIES = 5


class Command:
    """One run of ``muster base``; it is killed where a test leaves it running."""

    package = "base_station"
    by_the_modes = False
    quick_hash = True

    def __init__(self, output: Path, *arguments: str, stdin: str = "") -> None:
        self._output = output
        output.write_bytes(b"")
        self._program = LoadedProgram(
            Invocation(
                self.package,
                arguments,
                output,
                dict(os.environ),
                stdin=stdin,
                by_the_modes=self.by_the_modes,
                quick_hash=self.quick_hash,
            )
        )

    def __enter__(self) -> Command:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    @property
    def pid(self) -> int:
        return self._program.pid

    def runs(self) -> bool:
        return self._program.poll() is None

    def output(self) -> str:
        return self._output.read_text(errors="replace")

    def wait_ready(self) -> str:
        """The address of the console."""
        until(
            lambda: "\nready " in f"\n{self.output()}" or not self.runs(),
            "the station is ready or has ended",
        )
        assert self.runs(), f"the station ended:\n{self.output()}"
        (line,) = (line for line in self.output().splitlines() if line.startswith("ready "))
        return line.removeprefix("ready ")

    def wait(self) -> int:
        try:
            return self._program.wait(PATIENCE_S)
        except TimeoutError as error:
            raise AssertionError(f"it has not ended:\n{self.output()}") from error

    def stop(self, by: signal.Signals = signal.SIGTERM) -> int:
        self._program.send_signal(by)
        return self.wait()

    def kill(self) -> None:
        end_hard(self._program)


class CommandByModes(Command):
    """Run by a user to whom the modes of files apply: root may write to whatever it likes."""

    by_the_modes = True


class CommandOfCostlyLogins(Command):
    """Command of a station whose passwords take as long to check as those of an installed one."""

    quick_hash = False


class Agent(Command):
    """One run of ``muster edge run``."""

    package = "edge"

    def __init__(self, output: Path, *flags: str) -> None:
        super().__init__(output, "run", *flags)


class UnitCheck(Command):
    """One run of ``muster edge check``."""

    package = "edge"

    def __init__(self, output: Path, *flags: str) -> None:
        super().__init__(output, "check", *flags)


class Browser:
    """A person at the console."""

    def __init__(self, address: str, data: Path) -> None:
        self.address = address
        self._client = httpx.Client(
            base_url=f"{address}/api/v1",
            headers={"Origin": address},
            timeout=PATIENCE_S,
            verify=NO_AUTHORITIES,
        )
        text = (data / "first-login.txt").read_text()
        credentials = dict(line.split(": ", 1) for line in text.splitlines())
        me = self.call("POST", "/login", json=credentials)
        if me["must_change_password"]:
            self._change_password(data / "first-login.txt", credentials)

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._client.close()

    def _change_password(self, note: Path, credentials: dict[str, str]) -> None:
        """As the station asks at first; who comes later reads the new one."""
        old = credentials["password"]
        new = f"{old}-changed"
        self.call("POST", "/me/password", json={"old_password": old, "new_password": new})
        note.write_text(f"username: {credentials['username']}\npassword: {new}\n")

    def cookie(self) -> str:
        return "; ".join(f"{name}={value}" for name, value in self._client.cookies.items())

    def text(self, path: str) -> str:
        """An answer that is no JSON."""
        answer = self._client.get(path)
        assert answer.is_success, f"GET {path}: {answer.status_code} {answer.text}"
        return answer.text

    def call(self, method: str, path: str, **request: Any) -> Any:
        answer = self._client.request(method, path, **request)
        assert answer.is_success, f"{method} {path}: {answer.status_code} {answer.text}"
        return answer.json() if answer.content else None

    def close_incident(self, incident_id: str) -> int:
        """Over whatever alarms are open and whoever is inside, also where one more alarm is raised
        between two requests; the status of the last answer.
        """
        path = f"/incidents/{incident_id}/close"
        answer = self._client.post(path)
        for _ in range(_CLOSING_TRIES):
            if answer.status_code != HTTPStatus.CONFLICT:
                break
            answer = self._client.post(path, json=despite(answer.json()))
        return answer.status_code

    def status(self, method: str, path: str, **request: Any) -> int:
        return self._client.request(method, path, **request).status_code


class Unit:
    """A wearable as the bus sees it."""

    def __init__(self, port: int, unit_id: str, boot_id: int = 1) -> None:
        self.bus = ZenohBus(UnitEndpoint((f"tcp/127.0.0.1:{port}",)))
        self.header_factory = HeaderFactory(unit_id, boot_id, SystemClock())
        self._received = False

    def say(self, message: Message) -> None:
        """The first time it waits for the link: what is said without one is gone."""
        channel = channel_of(message)
        key = channel.key(self.header_factory.unit_id)
        if not self._received:
            until(lambda: self.bus.has_subscriber(key), "a station listens")
            self._received = True
        self.bus.publish(key, encode(message), channel.qos)

    def close(self) -> None:
        self.bus.close()
