"""Probe of the link to the other station's router, by a query over it."""

from __future__ import annotations

import secrets
import socket
from collections.abc import Iterator, Sequence

from base_station.config import endpoint_address
from shared.bus import Bus
from shared.channels import STATIONS_ROOT
from shared.errors import BusError

_KEY = f"{STATIONS_ROOT}/router"
_ANSWER_TIMEOUT_S = 1.0
_CONNECT_TIMEOUT_S = 0.3


class PeerRouterProbe:
    """Query to the other router, and answers to its queries.

    A link that Zenoh lists may carry nothing in one direction: that happens when two routers
    connect to each other at the same moment.
    """

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._name = secrets.token_hex(8).encode()
        self._serving = bus.serve(f"{_KEY}/{self._name.decode()}", self._replies)

    def responds(self) -> bool:
        """True where the other router answers; takes a second where the link carries nothing."""
        try:
            replies = self._bus.query(f"{_KEY}/*", b"", _ANSWER_TIMEOUT_S)
            return any(reply != self._name for reply in replies)
        except BusError:
            return False

    def close(self) -> None:
        self._serving.close()

    def _replies(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        yield self._name


def accepts_connections(endpoints: Sequence[str]) -> bool:
    """True where a program accepts connections there: the other machine and the network work."""
    for endpoint in endpoints:
        try:
            socket.create_connection(endpoint_address(endpoint), _CONNECT_TIMEOUT_S).close()
        except OSError:
            continue
        return True
    return False
