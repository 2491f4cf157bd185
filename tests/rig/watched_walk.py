"""Somebody walks and presses MAYDAY while a console looks on: what was sent, and what was shown."""

from __future__ import annotations

import json
import threading
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
from websockets.exceptions import ConnectionClosed

from base_station.core.events import Received, event_of
from shared.mcap_log import read_log
from shared.messages import EventKind, Header, UnitEvent
from tests.rig import message_factory
from tests.rig.plain_http import NO_AUTHORITIES
from tests.rig.served_station import watch
from tests.rig.station_command import Browser, Unit
from tests.rig.waiting import PATIENCE_S


class Walk:
    """Somebody walks, and a console looks on."""

    def __init__(self, browser: Browser, unit: Unit, closing: ExitStack) -> None:
        self._unit = unit
        self._socket = closing.enter_context(watch(browser))
        self._ending = threading.Event()
        self.stated: set[int] = set()  # sequence numbers
        self.shown = 0  # deltas with the unit in it
        self.problems: list[str] = []
        self.alarms: dict[str, str] = {}  # state by kind
        self.seen: dict[str, dict[str, Any]] = {}  # alarms, by rule
        for work in (self._walk, self._look):
            thread = threading.Thread(target=work, daemon=True)
            thread.start()
            closing.callback(thread.join)
        closing.callback(self._ending.set)

    def press_mayday(self) -> None:
        self._unit.say(UnitEvent(self._header(), EventKind.MAYDAY))

    def _header(self) -> Header:
        header = self._unit.header_factory.header()
        self.stated.add(header.seq)
        return header

    def _walk(self) -> None:
        while not self._ending.wait(0.1):
            header = self._header()
            self._unit.say(message_factory.position(header, north_m=0.1 * header.seq))

    def _look(self) -> None:
        while not self._ending.is_set():
            try:
                message = json.loads(self._socket.recv(1.0))
            except TimeoutError:
                continue
            except ConnectionClosed:
                return
            self.shown += bool(message.get("units"))
            if message.get("health"):
                self.problems = message["health"]["problems"]
            for alarm in message.get("alarms", ()):
                self.alarms[alarm["rule"]] = alarm["state"]
                self.seen[alarm["rule"]] = alarm


def logged(log: Path) -> list[int]:
    """Sequence numbers of what the unit said, as often as they stand there."""
    events = (event_of(*record) for record in read_log(log))
    headers = (event.message.header for event in events if isinstance(event, Received))
    return [header.seq for header in headers if header.unit_id == "FF-01"]


def post(browser: Browser, path: str, what: object, cookie: str = "") -> httpx.Response:
    """As slowly as the disk makes it."""
    headers = {"Origin": browser.address, "Cookie": cookie}
    address = f"{browser.address}/api/v1{path}"
    return httpx.post(
        address, headers=headers, json=what, timeout=PATIENCE_S, verify=NO_AUTHORITIES
    )


def login(browser: Browser, data: Path) -> httpx.Response:
    lines = (data / "first-login.txt").read_text().splitlines()
    return post(browser, "/login", dict(line.split(": ", 1) for line in lines))
