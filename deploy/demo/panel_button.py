"""Button of a simulated panel: tells its state to the unit, over a local socket."""

from __future__ import annotations

import socket
from pathlib import Path
from threading import Event, Lock, Thread


class PanelButton:
    """Listens until it is unplugged; each connection is told the state and its changes."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = Lock()
        self._is_pressed = False
        self._connections: list[socket.socket] = []
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(str(path))
        self._listener.listen()
        self._is_unplugged = Event()
        self._thread = Thread(target=self._serve, daemon=True)
        self._thread.start()

    @property
    def opened(self) -> bool:
        with self._lock:
            return any(not _has_ended(one) for one in self._connections)

    def press(self) -> None:
        self._turn(is_pressed=True)

    def release(self) -> None:
        self._turn(is_pressed=False)

    def unplug(self) -> None:
        """May be called again."""
        if self._is_unplugged.is_set():
            return
        self._is_unplugged.set()
        self._path.unlink()
        self._listener.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._listener.close()
        with self._lock:
            for connection in self._connections:
                connection.close()

    def _turn(self, *, is_pressed: bool) -> None:
        with self._lock:
            self._is_pressed = is_pressed
            for connection in self._connections:
                if not _has_ended(connection):
                    connection.sendall(self._line())

    def _line(self) -> bytes:
        return b"down\n" if self._is_pressed else b"up\n"

    def _serve(self) -> None:
        while not self._is_unplugged.is_set():
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return
            with self._lock:
                connection.sendall(self._line())
                self._connections.append(connection)


def _has_ended(connection: socket.socket) -> bool:
    try:
        return connection.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT) == b""
    except BlockingIOError:
        return False
    except OSError:
        return True
