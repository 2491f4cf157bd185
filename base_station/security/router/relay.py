"""Relay between two TLS connections: hands bytes on both ways until both directions have ended.

A client that leaves the bus sends its last messages and closes at once, while the other end may
still be writing to it.  So one direction that has ended, or fails, does not end the other: bytes
sent before the end are handed on first.
"""

from __future__ import annotations

import asyncio
import socket
import ssl
from collections.abc import Callable
from contextlib import suppress

_CHUNK_BYTES = 16_384  # the largest TLS record: nothing stays decrypted inside OpenSSL
_CHUNKS_PER_WAKEUP = 8  # others have their turn in between
_WAIT_ERRORS = (ssl.SSLWantReadError, ssl.SSLWantWriteError)
_HALF_CLOSED_S = 5.0  # how long the other direction has to end by itself


class Relay:
    """Passes bytes between two non-blocking connections; for the loop's thread."""

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        ends: tuple[ssl.SSLSocket, ssl.SSLSocket],
        on_end: Callable[[], None],
    ) -> None:
        self._loop = loop
        self._ends = ends
        self._on_end = on_end
        self._is_open = True
        first, second = ends
        self._directions = _Direction(self, first, second), _Direction(self, second, first)
        self._half_closed: asyncio.TimerHandle | None = None

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        return self._loop

    @property
    def is_open(self) -> bool:
        return self._is_open

    def start(self) -> None:
        for direction in self._directions:
            direction.start()

    def close(self) -> None:
        """Close both connections at once; ``on_end`` is called once."""
        if not self._is_open:
            return
        self._is_open = False
        if self._half_closed is not None:
            self._half_closed.cancel()
        for end in self._ends:
            self._loop.remove_reader(end.fileno())
            self._loop.remove_writer(end.fileno())
            end.close()
        self._on_end()

    def on_direction_end(self) -> None:
        """Close when both directions have ended, or some seconds after the first."""
        if all(direction.has_ended for direction in self._directions):
            self.close()
        elif self._half_closed is None:
            self._half_closed = self._loop.call_later(_HALF_CLOSED_S, self.close)


class _Direction:
    """Reads no more while what was read waits to be written: the sender's TCP holds it back."""

    __slots__ = ("_relay", "_sink", "_source", "_unsent", "has_ended")

    def __init__(self, relay: Relay, source: ssl.SSLSocket, sink: ssl.SSLSocket) -> None:
        self._relay = relay
        self._source = source
        self._sink = sink
        self._unsent = b""
        self.has_ended = False

    def start(self) -> None:
        if not self._relay.is_open:  # the other direction has found the end
            return
        self._relay.loop.add_reader(self._source.fileno(), self._read)
        self._read()  # bytes that came with the handshake cause no event

    def _read(self) -> None:
        try:
            for _ in range(_CHUNKS_PER_WAKEUP):
                data = self._source.recv(_CHUNK_BYTES)
                if not data:
                    self._end()
                    return
                if not self._write(data):
                    self._relay.loop.remove_reader(self._source.fileno())
                    return
                if len(data) < _CHUNK_BYTES:  # a whole record, and mostly there is no other
                    return
        except _WAIT_ERRORS:
            return
        except OSError:  # ssl.SSLError is one
            self._end()

    def _write(self, data: bytes) -> bool:
        """True where all of it is gone; else it goes when the other end takes more."""
        try:
            sent = self._sink.send(data)
        except _WAIT_ERRORS:
            sent = 0
        self._unsent = data[sent:]
        if self._unsent:
            self._relay.loop.add_writer(self._sink.fileno(), self._flush)
        return not self._unsent

    def _flush(self) -> None:
        try:
            if not self._write(self._unsent):
                return
        except OSError:
            self._end()
            return
        self._relay.loop.remove_writer(self._sink.fileno())
        self.start()

    def _end(self) -> None:
        """Pass the end on behind everything that was handed on before it."""
        self.has_ended = True
        self._relay.loop.remove_reader(self._source.fileno())
        self._relay.loop.remove_writer(self._sink.fileno())
        with suppress(OSError):  # the sink has gone
            # Not SSLSocket.shutdown, after which the other direction could not be decrypted.
            socket.socket.shutdown(self._sink, socket.SHUT_WR)
        self._relay.on_direction_end()
