"""Probe that detects at once when a station takes connections again.  A connection attempt without
radio repeats its first packet after 1, 2, 4 and more seconds, so it detects the radio's return
late.  The probe begins a new attempt several times a second; when one succeeds, the bus can be
opened.
"""

from __future__ import annotations

import errno
import select
import socket
import time
from collections.abc import Sequence
from typing import Any

_EVERY_S = 0.3
_AT_ONCE = 8  # attempts under way to each address; the oldest are given up first


class ReachabilityProbe:
    """Probe of ``proto/HOST:PORT`` endpoints; one thread, and ``close`` it."""

    def __init__(self, endpoints: Sequence[str]) -> None:
        self._places = [_host_and_port(endpoint) for endpoint in endpoints]
        self._attempts: list[socket.socket] = []
        self._next_s = 0.0

    def wait(self, timeout_s: float) -> bool:
        """Return True as soon as one of them takes a connection; False when the time is over."""
        end_s = time.monotonic() + timeout_s
        while (now_s := time.monotonic()) < end_s:
            if now_s >= self._next_s:
                self._next_s = now_s + _EVERY_S
                self._begin_attempts()
            if self._is_open(min(end_s, self._next_s) - now_s):
                self.close()
                return True
        return False

    def close(self) -> None:
        for attempt in self._attempts:
            attempt.close()
        self._attempts.clear()
        self._next_s = 0.0

    def _begin_attempts(self) -> None:
        """Begin a connection to each address of the names, as a station may listen on one of them
        only.
        """
        addresses = [found for place in self._places for found in _addresses(*place)]
        for family, kind, protocol, _, address in addresses:
            try:
                attempt = socket.socket(family, kind, protocol)
            except OSError:
                continue  # no such network on this machine
            attempt.setblocking(False)
            if attempt.connect_ex(address) in (0, errno.EINPROGRESS):
                self._attempts.append(attempt)
            else:
                attempt.close()  # no network at all
        for oldest in self._attempts[: -_AT_ONCE * max(len(addresses), 1)]:
            oldest.close()
            self._attempts.remove(oldest)

    def _is_open(self, timeout_s: float) -> bool:
        if not self._attempts:
            time.sleep(max(timeout_s, 0.0))
            return False
        answered = select.select([], self._attempts, [], max(timeout_s, 0.0))[1]
        for attempt in answered:
            if attempt.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) == 0:
                return True
            attempt.close()  # refused: the machine is there, the station is not
            self._attempts.remove(attempt)
        return False


def _addresses(host: str, port: int) -> list[Any]:
    """Return the addresses of ``getaddrinfo``; none where there is no such name, for now."""
    try:
        return socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    except OSError:
        return []


def _host_and_port(endpoint: str) -> tuple[str, int]:
    host, _, port = endpoint.partition("/")[2].rpartition(":")
    return host.strip("[]"), int(port)
