"""Notifications to systemd, or to whatever started this program and keeps it running.

The protocol is that of sd_notify(3): a datagram to the socket that the environment names.  A
program that has not said for too long that it works is ended and started anew (``WatchdogSec``).
"""

from __future__ import annotations

import socket
from collections.abc import Mapping

_SOCKET = "NOTIFY_SOCKET"


class ServiceManager:
    """Where nobody wants to hear, and where saying fails, nothing happens."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        address = environment.get(_SOCKET, "")
        self._address = f"\0{address[1:]}" if address.startswith("@") else address

    def ready(self) -> None:
        """The program does from now on what it is there for."""
        self._say(b"READY=1")

    def working(self) -> None:
        """Said once a second by the thread without which nothing works."""
        self._say(b"WATCHDOG=1")

    def _say(self, what: bytes) -> None:
        if not self._address:
            return
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as notification:
            notification.setblocking(False)
            try:
                notification.sendto(what, self._address)
            except OSError:  # it is away or does not listen: nothing that works depends on it
                return
