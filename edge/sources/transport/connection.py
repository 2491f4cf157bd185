"""Connections to hardware: TCP, a serial port, a pipe."""

from __future__ import annotations

import errno
import fcntl
import os
import select
import socket
import termios
from contextlib import ExitStack
from typing import Protocol

from shared.errors import ConfigError

_CHUNK = 4096
_READ_TIMEOUT_S = 0.5
_CONNECT_S = 2.0


class Connection(Protocol):
    """Open connection.  Failures are OSErrors."""

    def read(self) -> bytes | None:
        """Return data; empty: the other end is gone.  None: nothing for half a second."""
        ...

    def close(self) -> None: ...


class TcpConnection:
    """Connection to a TCP server."""

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.create_connection((host, port), timeout=_CONNECT_S)
        self._socket.settimeout(_READ_TIMEOUT_S)

    def read(self) -> bytes | None:
        try:
            return self._socket.recv(_CHUNK)
        except TimeoutError:
            return None

    def write(self, data: bytes) -> None:
        """Send to a server that wants to be asked.  Raises OSError."""
        self._socket.sendall(data)

    def close(self) -> None:
        self._socket.close()


class DeviceConnection:
    """Device or pipe as it is; a serial port is set up beforehand, say with ``stty``."""

    def __init__(self, path: str) -> None:
        self._descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY)

    def read(self) -> bytes | None:
        ready, _, _ = select.select([self._descriptor], [], [], _READ_TIMEOUT_S)
        try:
            return os.read(self._descriptor, _CHUNK) if ready else None
        except BlockingIOError:
            return None

    def close(self) -> None:
        os.close(self._descriptor)


class SerialConnection(DeviceConnection):
    """Serial port, eight bits as they come and no handshake, for this program alone."""

    def __init__(self, path: str, baud: int) -> None:
        speed = speed_of(baud)
        super().__init__(path)
        with ExitStack() as undo:
            undo.callback(self.close)
            self._set_up(path, speed)
            undo.pop_all()

    def _set_up(self, path: str, speed: int) -> None:
        if not os.isatty(self._descriptor):
            raise OSError(errno.ENOTTY, "not a serial port", path)
        try:
            fcntl.ioctl(self._descriptor, termios.TIOCEXCL)
            *_, controls = termios.tcgetattr(self._descriptor)
            modes = termios.CS8 | termios.CREAD | termios.CLOCAL
            attributes = [0, 0, modes, 0, speed, speed, controls]
            # What came at another speed is left out.
            termios.tcsetattr(self._descriptor, termios.TCSAFLUSH, attributes)
        except termios.error as error:  # which is no OSError
            raise OSError(*error.args) from error


def speed_of(baud: int) -> int:
    """Return the system's constant of a serial port's speed.  Raises ConfigError."""
    speed = getattr(termios, f"B{baud}", None) if baud > 0 else None
    if not isinstance(speed, int):
        known = sorted(int(name[1:]) for name in dir(termios) if _is_speed(name))
        raise ConfigError(f"baud is {baud}; this machine knows {', '.join(map(str, known))}")
    return speed


def _is_speed(name: str) -> bool:
    return name.startswith("B") and name[1:].isdecimal() and name != "B0"
