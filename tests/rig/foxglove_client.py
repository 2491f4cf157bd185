"""Client of Foxglove's WebSocket protocol, as the application is one.

https://github.com/foxglove/foxglove-sdk: text messages are JSON with ``op``; binary messages begin
with an opcode and have little-endian numbers.
"""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

_MESSAGE = struct.Struct("<BIQ")  # opcode, subscription, log time
_TIME = struct.Struct("<BQ")
_STATE = struct.Struct("<BBQf?I")  # opcode, status, time, speed, did seek, length of the request id
_REQUEST = struct.Struct("<BBf?QI")  # opcode, command, speed, seeks, time, length of the request id
# The library announces a channel just before it takes subscriptions to it (foxglove-sdk 0.30), and
# drops one that comes in between.  The application is beyond a network, and is never that quick.
_NETWORK_S = 0.02
PLAY, PAUSE = 0, 1
PLAYING, PAUSED, _, ENDED = range(4)


@dataclass(frozen=True, slots=True)
class State:
    """A playback state of the server."""

    status: int
    at_ns: int
    speed: float
    did_seek: bool
    request_id: str


@dataclass(slots=True)
class Received:
    """Messages of the server so far."""

    info: dict[str, Any] = field(default_factory=dict)
    channels: dict[int, dict[str, Any]] = field(default_factory=dict)  # by id
    messages: list[tuple[int, str, bytes]] = field(default_factory=list)  # log time, topic, payload
    times_ns: list[int] = field(default_factory=list)
    states: list[State] = field(default_factory=list)

    def topics(self) -> set[str]:
        return {channel["topic"] for channel in self.channels.values()}

    def on(self, topic: str) -> list[tuple[int, bytes]]:
        return [(t_ns, payload) for t_ns, key, payload in self.messages if key == topic]


@contextmanager
def foxglove_client(port: int) -> Iterator[FoxgloveClient]:
    """A client that is connected to a server on this machine."""
    protocols = [Subprotocol("foxglove.sdk.v1")]
    url = f"ws://127.0.0.1:{port}"
    with connect(url, subprotocols=protocols, max_size=None, proxy=None) as socket:
        yield FoxgloveClient(socket)


class FoxgloveClient:
    """Subscribes to every topic."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self.received = Received()

    def receive(self, duration_s: float = 0.05) -> Received:
        """Take all that comes within ``duration_s``."""
        until_s = time.monotonic() + duration_s
        while (left_s := until_s - time.monotonic()) > 0.0:
            try:
                message = self._socket.recv(left_s)
            except TimeoutError:
                break
            if isinstance(message, str):
                self._take_text(json.loads(message))
            else:
                self._take_binary(message)
        return self.received

    def control(
        self, command: int, *, speed: float = 1.0, seek_ns: int | None = None, request: str = "1"
    ) -> None:
        name = request.encode()
        head = _REQUEST.pack(3, command, speed, seek_ns is not None, seek_ns or 0, len(name))
        self._socket.send(head + name)

    def _take_text(self, message: dict[str, Any]) -> None:
        if message["op"] == "serverInfo":
            self.received.info = message
        elif message["op"] == "advertise":
            new = {channel["id"]: channel for channel in message["channels"]}
            self.received.channels |= new
            time.sleep(_NETWORK_S)
            subscriptions = [{"id": number, "channelId": number} for number in new]
            self._socket.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))

    def _take_binary(self, message: bytes) -> None:
        if message[0] == 1:
            _, number, t_ns = _MESSAGE.unpack_from(message)
            topic = self.received.channels[number]["topic"]
            self.received.messages.append((t_ns, topic, message[_MESSAGE.size :]))
        elif message[0] == 2:
            self.received.times_ns.append(_TIME.unpack(message)[1])
        elif message[0] == 5:
            _, status, at_ns, speed, did_seek, _ = _STATE.unpack_from(message)
            name = message[_STATE.size :].decode()
            self.received.states.append(State(status, at_ns, speed, did_seek, name))
