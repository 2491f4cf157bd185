"""Actions on a station that runs as a process, and the messages to its consoles."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from shared.messages import Position
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until

MakePosition = Callable[..., Position]


class Served(NamedTuple):
    """A station as a process, a console of it, and a unit that it receives."""

    station: Command
    browser: Browser
    unit: Unit
    data: Path
    flags: tuple[str, ...]  # to serve it again


@contextmanager
def served_station(
    data: Path, output: Path, make_position: MakePosition, *options: str
) -> Iterator[Served]:
    """Such a station on the folder; Ada wears the unit FF-01 in an open incident."""
    port = free_port()
    listens = ("--listen", f"tcp/127.0.0.1:{port}", "--http", "127.0.0.1:0")
    flags = ("serve", *options, "--data", str(data), *listens)
    with ExitStack() as closing:
        station = Command(output, *flags)
        closing.callback(station.kill)
        browser = closing.enter_context(Browser(station.wait_ready(), data))
        unit = Unit(port, "FF-01")
        closing.callback(unit.close)
        prepare(browser)
        greet(browser, unit, make_position)
        yield Served(station, browser, unit, data, flags)


def greet(browser: Browser, unit: Unit, make_position: MakePosition) -> None:
    """Until the unit is linked, what it says is lost."""

    def is_received() -> bool:
        unit.say(make_position(header=unit.header_factory.header()))
        return bool(browser.call("GET", "/health")["messages"])

    until(is_received, "the unit is heard")


def walk(unit: Unit, make_position: MakePosition, from_m: int, to_m: int) -> None:
    for north_m in range(from_m, to_m):
        unit.say(make_position(header=unit.header_factory.header(), north_m=float(north_m)))
        time.sleep(0.1)


def prepare(browser: Browser) -> str:
    """Ada wears FF-01 in an open incident; its id."""
    browser.call("POST", "/units", json={"unit_id": "FF-01", "label": "one"})
    person = browser.call("POST", "/people", json={"name": "Ada", "crew": "A"})
    worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
    browser.call("POST", "/assignments", json=worn)
    return str(browser.call("POST", "/incidents", json={"name": "Kitchen"})["incident_id"])


def watch(browser: Browser, path: str = "/live") -> ClientConnection:
    address = browser.address.replace("http", "ws", 1)
    return connect(f"{address}/api/v1{path}", additional_headers={"Cookie": browser.cookie()})


def close_code(socket_: ClientConnection) -> int | None:
    """With which the station ends it, which is to take seconds; None where it did not."""
    end_s = time.monotonic() + 10.0
    try:
        while time.monotonic() < end_s:
            socket_.recv(10.0)
    except ConnectionClosed as closed:
        return None if closed.rcvd is None else closed.rcvd.code
    return None


def snapshot(browser: Browser, path: str = "/live") -> dict[str, Any]:
    with watch(browser, path) as socket_:
        message: dict[str, Any] = json.loads(socket_.recv(10.0))
        assert message["type"] == "snapshot"
        return message


def trail(browser: Browser, path: str = "/live") -> dict[str, Any]:
    """The first of the trails that follow a snapshot."""
    with watch(browser, path) as socket_:
        while (message := json.loads(socket_.recv(10.0)))["type"] != "trail":
            pass
        return dict(message)
