"""Requests that umockdev's preloaded library passes on for a character device of its test bed.

It asks for every read, write and ioctl of the device, over a socket below ``UMOCKDEV_DIR``; here
each is done as it is, or fails with an error that a driver may give.
"""

from __future__ import annotations

import socket
import struct
from contextlib import suppress
from pathlib import Path
from threading import Thread

_MESSAGE = struct.Struct("@LlL")  # command and two arguments
_RESULT, _DONE, _RUN, _READ = 2, 3, 4, 7


class DeviceRequests:
    """Server for a device of the test bed in ``machine``, whose path has to be short."""

    def __init__(self, machine: Path, device: str) -> None:
        self.read_error: int | None = None  # with which reading fails from now on
        path = machine / "ioctl" / "dev" / device
        path.parent.mkdir(parents=True, exist_ok=True)
        self._server = socket.socket(socket.AF_UNIX)
        self._server.bind(str(path))
        self._server.listen()
        Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        with suppress(OSError):
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                connection, _ = self._server.accept()
                Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection: socket.socket) -> None:
        with connection, suppress(OSError):
            while request := connection.recv(_MESSAGE.size, socket.MSG_WAITALL):
                command, result, error = _MESSAGE.unpack(request)
                if command == _RESULT:
                    answer = (_DONE, result, error)
                elif command == _READ and self.read_error is not None:
                    answer = (_DONE, -1, self.read_error)
                else:
                    answer = (_RUN, 0, 0)
                connection.sendall(_MESSAGE.pack(*answer))
