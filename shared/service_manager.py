"""Notifications to systemd, or to whatever started this program and keeps it running.

The protocol is that of sd_notify(3): a datagram to the socket that the environment names.  A
program that has not reported in time that it works is restarted (``WatchdogSec``).
"""

from __future__ import annotations

import socket
from collections.abc import Mapping

_SOCKET = "NOTIFY_SOCKET"


class ServiceManager:
    """Sender of notifications; without a socket, or where sending fails, it does nothing."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        address = environment.get(_SOCKET, "")
        self._address = f"\0{address[1:]}" if address.startswith("@") else address

    def ready(self) -> None:
        """Notify that the start is complete."""
        self._notify(b"READY=1")

    def working(self) -> None:
        """Reset the watchdog; called once a second by the main thread."""
        self._notify(b"WATCHDOG=1")

    def _notify(self, what: bytes) -> None:
        if not self._address:
            return
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as notification:
            notification.setblocking(False)
            try:
                notification.sendto(what, self._address)
            except OSError:  # it is away or does not listen: nothing that works depends on it
                return
