"""Many consoles at once, some of which read slowly: they count what they get and look at nothing.

All in one thread, so that a hundred of them cost the machine little beside the station itself.
"""

from __future__ import annotations

import secrets
import selectors
import socket
import time
from base64 import b64encode
from threading import Event, Thread
from typing import NamedTuple
from urllib.parse import urlsplit

from shared.errors import StoreError
from tests.rig.console_client import Api

_SLOW_BYTES = 4096  # that a slow one reads at a time
_SLOW_EVERY_S = 0.5
_BUFFER_BYTES = 1 << 18
_SMALL_BUFFER_BYTES = 16_384
_PATIENCE_S = 30.0
_TEXT, _PING, _PONG = 1, 9, 10
_SNAPSHOT = b'{"type":"snapshot"'


class ConsoleTraffic(NamedTuple):
    """Traffic to consoles of one kind: of the one that got least, and in total."""

    onlookers: int
    least_messages: int
    snapshots: int
    cut_off: int


class ConsoleGroup:
    """``quick`` consoles that read whatever comes and ``slow`` ones that hardly do."""

    def __init__(self, api: Api, quick: int, slow: int) -> None:
        self._quick = [_Onlooker(api, _BUFFER_BYTES) for _ in range(quick)]
        self._slow = [_Onlooker(api, _SMALL_BUFFER_BYTES) for _ in range(slow)]
        self._closing = Event()
        self._thread = Thread(target=self._look, name="bench-onlookers", daemon=True)
        self._thread.start()

    def close(self) -> tuple[ConsoleTraffic, ConsoleTraffic]:
        """Closes all; traffic to the quick ones and to the slow ones."""
        self._closing.set()
        self._thread.join()
        for one in (*self._quick, *self._slow):
            one.close()
        return _seen(self._quick), _seen(self._slow)

    def _look(self) -> None:
        with selectors.DefaultSelector() as selector:
            for one in self._quick:
                selector.register(one.socket, selectors.EVENT_READ, one)
            slow_s = 0.0
            while not self._closing.is_set():
                for key, _ in selector.select(0.05):
                    if not key.data.read(_BUFFER_BYTES):
                        selector.unregister(key.fileobj)
                if time.monotonic() - slow_s >= _SLOW_EVERY_S:
                    slow_s = time.monotonic()
                    for one in self._slow:
                        one.read(_SLOW_BYTES)


class _Onlooker:
    """A WebSocket's client end: takes frames apart only to count messages and to answer pings."""

    def __init__(self, api: Api, buffer_bytes: int) -> None:
        self.messages = self.snapshots = 0
        self.is_cut_off = False
        self._waiting = bytearray()  # the beginning of a frame
        self._to_skip = 0  # bytes of a frame that has been counted
        url = urlsplit(api.live_url)
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
        self.socket.settimeout(_PATIENCE_S)
        self.socket.connect((url.hostname, url.port))
        self._shake_hands(url.path, f"{url.hostname}:{url.port}", api)
        self.socket.setblocking(False)

    def read(self, count: int) -> bool:
        """False: the station has cut it off."""
        try:
            data = self.socket.recv(count)
        except BlockingIOError:
            return True
        except OSError:
            data = b""
        self.is_cut_off = not data
        self._take(data)
        return bool(data)

    def close(self) -> None:
        self.socket.close()

    def _shake_hands(self, path: str, host: str, api: Api) -> None:
        lines = (
            f"GET {path} HTTP/1.1",
            f"Host: {host}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            f"Sec-WebSocket-Key: {b64encode(secrets.token_bytes(16)).decode()}",
            "Sec-WebSocket-Version: 13",
            f"Origin: {api.origin}",
            f"Cookie: {api.cookie}",
        )
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        answer = bytearray()
        while b"\r\n\r\n" not in answer:
            data = self.socket.recv(4096)
            if not data:
                break
            answer += data
        head, _, rest = bytes(answer).partition(b"\r\n\r\n")
        if b" 101 " not in head.partition(b"\r\n")[0]:
            raise StoreError(f"the station does not let an onlooker in: {head[:200]!r}")
        self._take(rest)

    def _take(self, data: bytes) -> None:
        """Frames of a server: two bytes, two or eight of length, no mask (RFC 6455)."""
        skipped = min(self._to_skip, len(data))
        self._to_skip -= skipped
        self._waiting += data[skipped:]
        while self._to_skip == 0 and len(self._waiting) >= 2:
            kind, short = self._waiting[0] & 0x0F, self._waiting[1] & 0x7F
            head = {126: 4, 127: 10}.get(short, 2)
            if len(self._waiting) < head:
                return
            length = short if head == 2 else int.from_bytes(self._waiting[2:head], "big")
            if len(self._waiting) < head + min(length, len(_SNAPSHOT)):
                return
            self._note(kind, bytes(self._waiting[head : head + min(length, 125)]))
            whole = head + length
            self._to_skip = max(whole - len(self._waiting), 0)
            del self._waiting[:whole]

    def _note(self, kind: int, beginning: bytes) -> None:
        if kind == _TEXT:
            self.messages += 1
            self.snapshots += beginning.startswith(_SNAPSHOT)
        elif kind == _PING:
            mask = secrets.token_bytes(4)
            masked = bytes(one ^ mask[place % 4] for place, one in enumerate(beginning))
            self.socket.send(bytes([0x80 | _PONG, 0x80 | len(beginning)]) + mask + masked)


def _seen(onlookers: list[_Onlooker]) -> ConsoleTraffic:
    return ConsoleTraffic(
        len(onlookers),
        min((one.messages for one in onlookers), default=0),
        sum(one.snapshots for one in onlookers),
        sum(one.is_cut_off for one in onlookers),
    )
