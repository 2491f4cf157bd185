"""The HTTP server: uvicorn on a socket of our own, stopped by us."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import signal
import socket
from collections.abc import Callable, Generator
from pathlib import Path

import uvicorn
from starlette.types import ASGIApp

from base_station import collector
from shared.errors import ConfigError

_GRACE_S = 5
_HOUSEKEEPING_S = 5.0
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
        """Raises ConfigError where the certificate or its key cannot be used."""
        self._socket = listening
        self._scheme = "http" if certificate is None else "https"
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
        try:
            config.load()
        except OSError as error:  # ssl.SSLError is one
            raise ConfigError(
                f"the console's certificate {certificate} with the key {private_key} cannot be "
                f"used: {error}"
            ) from error
        self._server = _Server(config)

    @property
    def address(self) -> str:
        """As a browser on this machine writes it."""
        host, port = self._socket.getsockname()[:2]
        return f"{self._scheme}://{f'[{host}]' if ':' in host else host}:{port}"

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


async def serve_until_stopped(
    server: ConsoleServer,
    announce: Callable[[str], None],
    housekeeping: Callable[[], None] = lambda: None,
) -> None:
    """Serve until SIGINT or SIGTERM, and say ``ready ADDRESS`` once consoles can connect.

    ``housekeeping`` is called now and then, in a thread.
    """
    collector.settle()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, server.stop)
    serving = asyncio.create_task(server.serve())
    starting = asyncio.create_task(server.wait_started())
    await asyncio.wait({serving, starting}, return_when=asyncio.FIRST_COMPLETED)
    if starting.done():
        announce(f"ready {server.address}")
    starting.cancel()
    while not serving.done():
        await asyncio.to_thread(housekeeping)
        await asyncio.wait({serving}, timeout=_HOUSEKEEPING_S)
    await serving


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
