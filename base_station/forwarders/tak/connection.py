"""Connection to a TAK server or multicast group, over the library ``pytak``."""

from __future__ import annotations

import asyncio
import socket
import ssl
import warnings
from collections.abc import Awaitable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from base_station.forwarders.tak.config import TakConfig
from shared.coded_text import coded

_CONNECT_S = 10.0
_DRAIN_S = 10.0  # a server that takes nothing for so long has stalled
_READ_BYTES = 65_536
_SEND_BUFFER_BYTES = 131_072  # data that waits in it is not the newest any more
_GONE_AFTER_MS = 20_000  # without a confirmation of sent data by the other machine
_DATAGRAM_BYTES = 65_000
# Every call of the system waits its turn among the station's threads, up to 5 ms on a busy one.
_BATCH_BYTES = 16_384
_STALLED = "takes nothing that is sent"


NO_ANSWER = coded("tak-no-answer", "does not answer")


class ConnectionLostError(Exception):
    """Loss of the connection, as a phrase for a person."""


class TakConnection:
    """Open connection to a server or a group."""

    def __init__(self, reader: Any, writer: Any) -> None:
        self._reader, self._writer = reader, writer

    async def send(self, events: Sequence[bytes]) -> None:
        """Send events.  Raises ConnectionLostError if the other end does not take them."""
        if hasattr(self._writer, "drain"):
            self._writer.write(b"".join(events))
            await _within(self._writer.drain(), _DRAIN_S, _STALLED)
            return
        for event in events:  # one a datagram
            if len(event) <= _DATAGRAM_BYTES:
                await _within(self._writer.send(event), _DRAIN_S, _STALLED)

    async def receive(self) -> bytes:
        """Return received bytes, at most a datagram or ``_READ_BYTES``. Raises
        ConnectionLostError.
        """
        try:
            if hasattr(self._reader, "recv"):
                data, _ = await self._reader.recv()
                is_over = data is None  # an empty datagram is rubbish, and no end
            else:
                data = await self._reader.read(_READ_BYTES)
                is_over = not data
        except OSError as error:
            raise ConnectionLostError(
                coded("tak-broken", "has broken the connection: {error}", error=str(error))
            ) from error
        if is_over:
            raise ConnectionLostError(coded("tak-closed", "has closed the connection"))
        return bytes(data)

    def close(self) -> None:
        """Close at once; nothing that still waits needs to be sent."""
        for end in (self._writer, self._reader):
            transport = getattr(end, "transport", None)
            if transport is not None:
                transport.abort()
            elif hasattr(end, "close"):
                end.close()


def in_batches(events: Iterable[bytes]) -> Iterator[list[bytes]]:
    """Group events for one call each; an event is requested only when its batch is made."""
    batch: list[bytes] = []
    size = 0
    for event in events:
        batch.append(event)
        size += len(event)
        if size >= _BATCH_BYTES:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch


async def open_connection(config: TakConfig) -> TakConnection:
    """Open a connection.  Raises ConnectionLostError with the reason."""
    reader, writer = await _within(
        _library().protocol_factory(_pytak_settings(config)), _CONNECT_S, NO_ANSWER
    )
    if not config.is_datagram:
        _bound_buffers(writer)
    return TakConnection(reader, writer)


def _library() -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its enrolment over HTTP, which is not used
        # A seventh of a second of a start, which a station without TAK does without.
        import pytak  # noqa: PLC0415
    return pytak


def _bound_buffers(writer: asyncio.StreamWriter) -> None:
    connected: socket.socket = writer.get_extra_info("socket")
    connected.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _GONE_AFTER_MS)


def _pytak_settings(config: TakConfig) -> dict[str, str]:
    settings = {
        "COT_URL": config.url,
        "PYTAK_MULTICAST_LOCAL_ADDR": config.interface,
        "PYTAK_TLS_CLIENT_CIPHERS": "HIGH:!aNULL:!eNULL",
        "PYTAK_TLS_SERVER_EXPECTED_HOSTNAME": config.server_name or urlsplit(config.url).hostname,
        "PYTAK_TLS_CLIENT_CERT": _text(config.certificate),
        "PYTAK_TLS_CLIENT_KEY": _text(config.private_key or config.certificate),
        "PYTAK_TLS_CLIENT_CAFILE": _text(config.ca),
        "PYTAK_TLS_CLIENT_PASSWORD": _password(config.password_file),
    }
    return {key: value for key, value in settings.items() if value}


def _text(path: Path | None) -> str:
    return "" if path is None else str(path)


def _password(path: Path | None) -> str:
    if path is None:
        return ""
    try:
        return path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConnectionLostError(
            coded(
                "tak-password-unreadable",
                "cannot be reached: {path} cannot be read ({error})",
                path=str(path),
                error=str(error),
            )
        ) from error


async def _within(work: Awaitable[Any], timeout_s: float, phrase: str) -> Any:
    try:
        return await asyncio.wait_for(work, timeout_s)
    except TimeoutError:
        raise ConnectionLostError(phrase) from None
    except ConnectionLostError:
        raise
    except ssl.SSLError as error:
        raise ConnectionLostError(
            coded("tak-tls", "does not agree on TLS: {error}", error=_reason_of(error))
        ) from error
    except (OSError, SyntaxError, ValueError) as error:  # pytak's own of certificates, too
        raise ConnectionLostError(
            coded("tak-unreachable", "cannot be reached: {error}", error=_reason_of(error))
        ) from error


def _reason_of(error: Exception) -> str:
    cause = error.__cause__ if isinstance(error, SyntaxError | ValueError) else None
    return str(cause or error) or type(cause or error).__name__
