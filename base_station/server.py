"""The HTTP server: uvicorn on a socket of our own, stopped by us."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
from collections.abc import Generator
from pathlib import Path

import uvicorn
from starlette.types import ASGIApp

from shared.errors import ConfigError

_GRACE_S = 5
_BACKLOG = 512
_LARGEST_REQUEST_BYTES = 4096  # over a WebSocket: all that is asked is a snapshot


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        """Signals are the station's, which stops everything in order."""
        yield


class ConsoleServer:
    """Serves an application on a socket from ``bind``, over TLS where it has a certificate."""

    def __init__(
        self,
        app: ASGIApp,
        listening: socket.socket,
        certificate: Path | None = None,
        private_key: Path | None = None,
    ) -> None:
        self._socket = listening
        config = uvicorn.Config(
            app,
            ssl_certfile=certificate,
            ssl_keyfile=private_key,
            log_config=None,
            log_level="warning",
            access_log=False,
            server_header=False,
            proxy_headers=False,  # who asks is who connected: logins are counted by it
            ws_per_message_deflate=False,  # one encoding for all consoles
            ws_max_size=_LARGEST_REQUEST_BYTES,
            timeout_graceful_shutdown=_GRACE_S,
        )
        self._server = _Server(config)

    async def serve(self) -> None:
        """Until ``stop``."""
        try:
            await self._server.serve(sockets=[self._socket])
        finally:
            self._socket.close()

    async def wait_started(self) -> None:
        while not self._server.started:
            await asyncio.sleep(0.01)

    def stop(self) -> None:
        """From the loop's thread."""
        self._server.should_exit = True


def bind(host: str, port: int) -> socket.socket:
    """Take the port; raises ConfigError where another program has it."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        bound = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ConfigError(f"the console cannot listen on {host}:{port}: {error}") from error
    try:
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        bound.bind(address)
        bound.listen(_BACKLOG)
    except OSError as error:
        bound.close()
        if error.errno == errno.EADDRINUSE:
            raise ConfigError(
                f"port {port} on {host} is in use by another program: stop that one, or give the "
                "console another port with --http HOST:PORT"
            ) from error
        raise ConfigError(f"the console cannot listen on {host}:{port}: {error}") from error
    bound.setblocking(False)
    return bound
