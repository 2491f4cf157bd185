"""Consoles without a screen: log in over HTTP, then listen on the WebSocket as a browser does."""

from __future__ import annotations

import json
import time
import urllib.request
from contextlib import ExitStack
from threading import Event, Thread
from typing import Any

import msgspec
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from shared.errors import StoreError
from tests.rig.pacing import PATIENCE_S


class _PositionSeen(msgspec.Struct):
    t_ms: int


class _UnitSeen(msgspec.Struct):
    unit_id: str
    link: str = ""
    position: _PositionSeen | None = None


class _HealthSeen(msgspec.Struct):
    messages: int
    problems: tuple[str, ...] = ()


class _MessageSeen(msgspec.Struct):
    """The parts of a message that the figures need."""

    type: str
    seq: int = 0  # of a snapshot or delta
    units: tuple[_UnitSeen, ...] = ()
    health: _HealthSeen | None = None


class Api:
    """The station's API as a logged-in commander."""

    def __init__(self, url: str, username: str, password: str) -> None:
        self._url = url
        reply = self._open("POST", "/login", {"username": username, "password": password}, "")
        self.cookie = reply.headers["set-cookie"].partition(";")[0]

    @property
    def live_url(self) -> str:
        return self._url.replace("http", "ws", 1) + "/api/v1/live"

    @property
    def origin(self) -> str:
        return self._url

    def get(self, path: str) -> Any:
        return json.load(self._open("GET", path, None, self.cookie))

    def put(self, path: str, body: dict[str, Any]) -> Any:
        with self._open("PUT", path, body, self.cookie) as answer:
            return json.loads(answer.read() or b"null")

    def post(self, path: str, body: dict[str, Any]) -> Any:
        """Answer of the station; None if it is empty."""
        with self._open("POST", path, body, self.cookie) as answer:
            return json.loads(answer.read() or b"null")

    def _open(self, method: str, path: str, body: dict[str, Any] | None, cookie: str) -> Any:
        request = urllib.request.Request(  # our own station's address
            f"{self._url}/api/v1{path}",
            method=method,
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json", "Origin": self._url, "Cookie": cookie},
        )
        return urllib.request.urlopen(request, timeout=PATIENCE_S)


class Console:
    """Listens in a thread of its own and notes when each unit's position was shown."""

    def __init__(self, api: Api, closing: ExitStack) -> None:
        """Closed by ``closing``, or before by ``close``."""
        self.shown: dict[str, dict[int, int]] = {}  # unit -> t_ms of a position -> first seen, ns
        self.links: dict[str, str] = {}  # as shown last
        self.messages_stepped = 0
        self.problems: tuple[str, ...] = ()
        self.bytes_received = 0
        self.snapshots = 0
        self.gaps = 0
        self.units_shown = 0  # in the first snapshot
        self._seq: int | None = None
        self._ready = Event()
        self._socket: ClientConnection = closing.enter_context(
            connect(
                api.live_url,
                additional_headers={"Cookie": api.cookie, "Origin": api.origin},
                max_size=None,
                compression=None,
            )
        )
        self._thread = Thread(target=self._listen, name="bench-console", daemon=True)
        self._thread.start()

    def wait_ready(self, timeout_s: float) -> bool:
        """The first snapshot is there."""
        return self._ready.wait(timeout_s)

    def close(self) -> None:
        self._socket.close()
        self._thread.join()

    def _listen(self) -> None:
        decoder = msgspec.json.Decoder(_MessageSeen)
        try:
            for text in self._socket:
                seen_ns = time.time_ns()
                self.bytes_received += len(text)
                self._note(decoder.decode(text), seen_ns)
        except ConnectionClosed:
            return

    def _note(self, message: _MessageSeen, seen_ns: int) -> None:
        if message.type == "trail":
            return
        if message.type == "snapshot":
            self.snapshots += 1
            self.units_shown = self.units_shown or len(message.units)
            self._ready.set()
        elif self._seq is not None and message.seq != self._seq + 1:
            self.gaps += 1
        self._seq = message.seq
        for unit in message.units:
            self.links[unit.unit_id] = unit.link
            if unit.position is not None:
                self.shown.setdefault(unit.unit_id, {}).setdefault(unit.position.t_ms, seen_ns)
        if message.health is not None:
            self.messages_stepped = message.health.messages
            self.problems = message.health.problems


def watching(api: Api, count: int, closing: ExitStack) -> list[Console]:
    """So many consoles that see something; StoreError where they do not."""
    consoles = [Console(api, closing) for _ in range(count)]
    if not all(console.wait_ready(PATIENCE_S) for console in consoles):
        raise StoreError("the station to be measured shows nothing at its consoles")
    return consoles
