"""Button that another program presses, over a local socket: a simulated panel, or a device that no
kernel driver knows.

The program listens on a Unix socket; the unit connects.  Each line is the contact's state from now
on, ``down`` or ``up``; the first is the state at the connection.
"""

from __future__ import annotations

import select
import socket
from collections import deque
from pathlib import Path

from edge.wearer.interface import ButtonError, ContactChange
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import ConfigError

_STATES = {b"down": True, b"up": False}
_FIRST_WAIT_S = 1.0
_BYTES_MAX = 4096
_LINE_MAX = 64


class SocketButton:
    """Button at the socket of a path; see ``ButtonDriver``."""

    def __init__(self, path: str, options: dict[str, str], clock: Clock) -> None:
        """Raises ConfigError."""
        if options:
            raise ConfigError(f"socket:{path}: unknown option {next(iter(options))!r}; it has none")
        if not path.startswith("/"):
            raise ConfigError(f"socket:{path}: write the whole path of the socket")
        self._path = Path(path)
        self._clock = clock
        self._connection: socket.socket | None = None
        self._partial = b""
        self._changes: deque[ContactChange] = deque()

    def open(self) -> None:
        self.close()
        self._partial, self._changes = b"", deque()
        self._connection = connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        connection.setblocking(False)
        try:
            connection.connect(str(self._path))
        except FileNotFoundError as error:
            raise ButtonError(
                coded(
                    "button-no-socket",
                    "there is no socket {path}; start the program that has the button",
                    path=str(self._path),
                )
            ) from error
        except (ConnectionRefusedError, BlockingIOError) as error:
            raise ButtonError(
                coded(
                    "button-no-listener",
                    "nothing listens at {path}; start the program that has the button",
                    path=str(self._path),
                )
            ) from error
        self.wait(_FIRST_WAIT_S)
        self._receive()
        if not self._changes:
            raise ButtonError(
                coded(
                    "button-no-state",
                    "the program at {path} does not tell the button's state",
                    path=str(self._path),
                )
            )

    def wait(self, timeout_s: float) -> None:
        if self._connection is not None and not self._changes:
            select.select([self._connection], [], [], timeout_s)

    def read(self) -> tuple[ContactChange, ...]:
        self._receive()
        changes, self._changes = tuple(self._changes), deque()
        return changes

    def close(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def _receive(self) -> None:
        assert self._connection is not None
        try:
            received = self._connection.recv(_BYTES_MAX)
        except BlockingIOError:
            return
        if not received:
            raise ButtonError(
                coded("button-ended", "the program at {path} has ended", path=str(self._path))
            )
        *lines, self._partial = (self._partial + received).split(b"\n")
        if len(self._partial) > _LINE_MAX:
            raise ButtonError(
                coded(
                    "button-no-lines", "the program at {path} sends no lines", path=str(self._path)
                )
            )
        now_ns = self._clock.monotonic_ns()
        for line in lines:
            is_pressed = _STATES.get(line.strip())
            if is_pressed is None:
                raise ButtonError(
                    coded(
                        "button-no-words",
                        "the program at {path} sends neither down nor up",
                        path=str(self._path),
                    )
                )
            self._changes.append(ContactChange(now_ns, is_pressed))
