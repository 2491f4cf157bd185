"""A pretended x-IMU3: says what it is given to whoever connects, on TCP or on a pseudo terminal."""

from __future__ import annotations

import os
import pty
import socket
import struct
import termios
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from threading import Event, Thread

import numpy as np

from edge.samples import ImuBatch

G_MPS2 = 9.80665
STEP_US = 2500


def text_message(kind: str, t_us: int, *values: float) -> bytes:
    return ",".join((kind, str(t_us), *(f"{value:.4f}" for value in values))).encode() + b"\r\n"


def binary_message(kind: str, t_us: int, *values: float) -> bytes:
    plain = bytes([0x80 + ord(kind)]) + struct.pack(f"<Q{len(values)}f", t_us, *values)
    return plain.replace(b"\xdb", b"\xdb\xdd").replace(b"\n", b"\xdb\xdc") + b"\n"


def at_rest(count: int, first: int = 0) -> list[bytes]:
    """Messages of a device on a table, with what comes beside the inertial ones."""
    reported = []
    for k in range(first, first + count):
        t_us = k * STEP_US
        reported.append(text_message("I", t_us, 0.01 * (k % 7), 0.02, -0.03, 0.001, 0.002, 1.0))
        if k % 20 == 0:
            reported.append(text_message("M", t_us, 0.4, 0.0, 0.9))
        if k % 80 == 0:
            reported.append(text_message("B", t_us, 87.5, 4.1, 0.0))
            reported.append(text_message("T", t_us, 31.25))
    return reported


def played(imu: ImuBatch, binary: bool = False) -> Iterator[tuple[float, bytes]]:
    """A recording as messages, each with the second at which it is due."""
    message = binary_message if binary else text_message
    gyro_dps, accel_g = np.degrees(imu.gyro_radps), imu.accel_mps2 / G_MPS2
    for t_ns, gyro, accel in zip(imu.t_ns.tolist(), gyro_dps, accel_g, strict=True):
        yield t_ns * 1e-9, message("I", t_ns // 1000, *gyro.tolist(), *accel.tolist())


class TcpDevice:
    """Each of ``sessions`` is said to one connection, which then ends, or ``hangs`` until the other
    end has enough of it.
    """

    def __init__(self, *sessions: Iterable[bytes], port: int = 0, hangs: bool = False) -> None:
        self._hangs = hangs
        self._server = socket.create_server(("127.0.0.1", port))
        self._sessions = sessions
        self.port: int = self._server.getsockname()[1]
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def source(self) -> str:
        return f"tcp://127.0.0.1:{self.port}"

    def close(self) -> None:
        with suppress(OSError):
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self._thread.join(5.0)

    def _run(self) -> None:
        with suppress(OSError):
            for session in self._sessions:
                connection, _ = self._server.accept()
                with connection, suppress(ConnectionError):
                    connection.settimeout(30.0)
                    self.greet(connection)
                    for part in session:
                        connection.sendall(part)
                    if self._hangs:
                        connection.recv(1)

    def greet(self, connection: socket.socket) -> None:
        """Bytes before each session: none."""


class PtyDevice:
    """A serial port, on which something is said when somebody has opened and set it up."""

    def __init__(self, reported: Iterable[bytes]) -> None:
        self._ours, self._theirs = pty.openpty()
        self.source = os.ttyname(self._theirs)
        self._stated = reported
        self._closed = Event()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """The cable is pulled."""
        self._closed.set()
        self._thread.join(5.0)
        for descriptor in (self._ours, self._theirs):
            with suppress(OSError):
                os.close(descriptor)
        self._ours = self._theirs = -1

    def _run(self) -> None:
        while termios.tcgetattr(self._ours)[3] & termios.ICANON:
            if self._closed.wait(0.01):
                return
        for part in self._stated:
            if self._closed.is_set():
                return
            os.write(self._ours, part)


def paced(messages: Iterable[tuple[float, bytes]]) -> Iterator[bytes]:
    """In real time, by the tenth of a second as a radio would."""
    began_s = time.monotonic()
    for due_s, message in messages:
        time.sleep(max(0.0, due_s - (time.monotonic() - began_s)))
        yield message
