"""Stream of messages between a station and a process that works on the past for it.

Each message is msgpack with its length before it; ``jobs`` and ``wire`` have the messages.
"""

from __future__ import annotations

import select
import socket
import struct
from contextlib import suppress
from threading import Lock

import msgspec

from base_station.replay.processes.jobs import Job
from base_station.replay.processes.wire import (
    CaughtUp,
    Command,
    CopiesDone,
    CopyFrame,
    PostProcessingReport,
    RehearsalFrame,
    ReplayReport,
    ReportFrame,
    TimelineFrame,
)
from shared.coded_text import coded
from shared.errors import StoreError

_LENGTH = struct.Struct("<Q")  # before each message


class FrameChannel:
    """One end of a stream of messages; one thread reads, and any may call the rest."""

    def __init__(self, end: socket.socket) -> None:
        self._end = end
        self._sending = Lock()

    def send(
        self,
        message: Job
        | Command
        | ReplayReport
        | PostProcessingReport
        | ReportFrame
        | RehearsalFrame
        | CaughtUp
        | TimelineFrame
        | CopyFrame
        | CopiesDone,
    ) -> None:
        """Raises StoreError where the other end is gone."""
        encoded = msgspec.msgpack.encode(message)
        with self._sending:
            try:
                self._end.sendall(_LENGTH.pack(len(encoded)) + encoded)
            except OSError as error:
                raise StoreError(
                    coded("process-ended", "the other process has ended: {error}", error=str(error))
                ) from error

    def has_message(self, timeout_s: float) -> bool:
        """Wait; return True where a message has come, or the other end is gone."""
        poll = select.poll()  # not select, which knows only the first 1,024 files of a program
        poll.register(self._end, select.POLLIN)
        return bool(poll.poll(1000.0 * timeout_s))

    def receive(self) -> bytes | None:
        """The next message, waiting for it; None: the other end is gone."""
        length = self._bytes(_LENGTH.size)
        return None if length is None else self._bytes(_LENGTH.unpack(length)[0])

    def hang_up(self) -> None:
        """Shut down: readers at both ends find that the other one is gone."""
        with suppress(OSError):  # the other end has done so already
            self._end.shutdown(socket.SHUT_RDWR)

    def stop_sending(self) -> None:
        """Shut down one direction: the other process ends, and ``receive`` waits for that."""
        with suppress(OSError):  # the other process has ended already
            self._end.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """Close this end; called by the thread that reads."""
        self._end.close()

    def _bytes(self, count: int) -> bytes | None:
        found = bytearray(count)
        view, begin = memoryview(found), 0
        while begin < count:
            try:
                came = self._end.recv_into(view[begin:])
            except OSError:
                return None
            if not came:
                return None
            begin += came
        return bytes(found)
