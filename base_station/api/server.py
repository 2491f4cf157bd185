"""HTTP server: uvicorn on the station's own socket, stopped by the station."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import signal
import socket
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from base_station.api.connections import ConnectionLimitedSocket
from base_station.api.shared_deflate import WebSocketProtocol
from base_station.config import HttpConfig
from base_station.process import gc_tuning
from base_station.process.log_rate_limit import RateLimitFilter
from shared.clock import SystemClock
from shared.errors import ConfigError
from shared.log_on_change import LogOnChange

_SHUTDOWN_GRACE_S = 5
_HOUSEKEEPING_S = 5.0
_BACKLOG = 512
_ACCEPTS_PER_WAKEUP = 16  # before existing connections are served again
_MAX_MESSAGE_BYTES = 4096  # over a WebSocket: the only request is for a snapshot
_REQUEST_TIMEOUT_S = 10.0  # the head of a request, and before it the greeting of TLS
# A body comes at this rate at least, for a radio that loses much, or it is not waited for.
_BODY_TIMEOUT_S = 20.0
_MIN_BODY_BYTES_PER_S = 10_000.0


_log = logging.getLogger(__name__)
_SERVER_LOG = logging.getLogger("uvicorn.error")  # all that it logs of requests


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        """Do nothing: the station handles signals itself, and stops everything in order."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen with our own connection class, as uvicorn allows a client a minute for its TLS
        handshake.
        """
        await super().startup(sockets=[])
        config = self.config

        def new_connection() -> _Connection:
            return _Connection(config, self.server_state, self.lifespan.state)

        for one in sockets or ():
            listener = await asyncio.get_running_loop().create_server(
                new_connection,
                sock=one,
                backlog=_ACCEPTS_PER_WAKEUP,
                ssl=config.ssl,
                ssl_handshake_timeout=_REQUEST_TIMEOUT_S if config.ssl else None,
            )
            self.servers.append(listener)
            one.listen(_BACKLOG)  # asyncio takes one number for both


class _Connection(H11Protocol):
    """HTTP connection with timeouts for head and body; an idle connection is closed."""

    _timer: asyncio.TimerHandle | None = None
    _body_since_s: float | None = None  # None: no body is waited for
    _body_bytes = 0  # since then
    _is_websocket = False  # by now: another protocol minds it

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._reset_timeout()

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._body_bytes += len(data)
        self._reset_timeout()

    def handle_websocket_upgrade(self, event: Any) -> None:
        self._is_websocket = True  # this one is not notified of its end
        self._cancel_timeout()
        super().handle_websocket_upgrade(event)

    def connection_lost(self, exc: Exception | None) -> None:
        self._cancel_timeout()
        super().connection_lost(exc)

    def _reset_timeout(self) -> None:
        if self._is_websocket:
            return
        answering = getattr(self.cycle, "response_complete", True) is False
        if answering:
            self._cancel_timeout()
        if answering and self.cycle.more_body:
            self._reset_body_timeout()
            return
        self._body_since_s = None
        if not answering and self._timer is None:
            self._timer = self.loop.call_later(_REQUEST_TIMEOUT_S, self._on_timeout)

    def _reset_body_timeout(self) -> None:
        """Set the timeout again by the number of bytes that the body has so far, however small its
        parts are.
        """
        now_s = self.loop.time()
        if self._body_since_s is None:
            self._body_since_s, self._body_bytes = now_s, 0
        allowed_s = _BODY_TIMEOUT_S + self._body_bytes / _MIN_BODY_BYTES_PER_S
        left_s = self._body_since_s + allowed_s - now_s
        self._timer = self.loop.call_later(max(left_s, 0.0), self._on_timeout)

    def _cancel_timeout(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _on_timeout(self) -> None:
        self._timer = None
        if self.flow.read_paused:  # the station lets the body wait
            self._body_since_s = None
            self._reset_timeout()
        else:
            self.transport.close()


class ConsoleServer:
    """Serves an application on a socket from ``bind``, over TLS where it has a certificate."""

    def __init__(
        self,
        app: ASGIApp,
        listening: socket.socket,
        certificate: Path | None = None,
        private_key: Path | None = None,
        *,
        on_stop: Callable[[], None] = lambda: None,
        is_known: Callable[[str], bool] = lambda _: True,
    ) -> None:
        """``on_stop`` is called at each request to stop.  ``is_known`` tells whether a user is
        logged in from an address; other addresses may have fewer connections.

        Raises ConfigError if the certificate or its key cannot be used.
        """
        self._socket = listening
        if isinstance(listening, ConnectionLimitedSocket):
            listening.is_known = is_known
        self._on_stop = on_stop
        host, port = listening.getsockname()[:2]
        scheme = "http" if certificate is None else "https"
        # As a browser on this machine writes it.
        self.address = f"{scheme}://{f'[{host}]' if ':' in host else host}:{port}"
        config = uvicorn.Config(
            app,
            ssl_certfile=certificate,
            ssl_keyfile=private_key,
            log_config=None,
            log_level="warning",
            access_log=False,
            server_header=False,
            proxy_headers=False,  # the client is the connected address: logins are counted by it
            ws=WebSocketProtocol,
            ws_max_size=_MAX_MESSAGE_BYTES,
            timeout_graceful_shutdown=_SHUTDOWN_GRACE_S,
        )
        try:
            config.load()
        except OSError as error:  # ssl.SSLError is one
            raise ConfigError(
                f"the console's certificate {certificate} with the key {private_key} cannot be "
                f"used: {error}"
            ) from error
        self._server = _Server(config)
        self._log_limiter = RateLimitFilter(SystemClock())

    async def serve(self) -> None:
        """Serve until ``stop`` is called."""
        _SERVER_LOG.addFilter(self._log_limiter)
        try:
            await self._server.serve(sockets=[self._socket])
        finally:
            _SERVER_LOG.removeFilter(self._log_limiter)
            self._socket.close()

    async def wait_started(self) -> None:
        while not self._server.started:
            await asyncio.sleep(0.01)

    def stop(self) -> None:
        """Stop serving; to be called in the event loop's thread."""
        self._server.should_exit = True
        self._on_stop()


async def serve_until_stopped(
    server: ConsoleServer,
    announce: Callable[[str], None],
    housekeeping: Callable[[], None] = lambda: None,
) -> None:
    """Serve until SIGINT or SIGTERM, and print ``ready ADDRESS`` once consoles can connect.

    ``housekeeping`` is called regularly in a thread; if it fails, the station continues.
    """
    gc_tuning.freeze()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, server.stop)
    serving = asyncio.create_task(server.serve())
    starting = asyncio.create_task(server.wait_started())
    await asyncio.wait({serving, starting}, return_when=asyncio.FIRST_COMPLETED)
    if starting.done() and not serving.done():  # it may have been stopped as it began
        announce(f"ready {server.address}")
    starting.cancel()
    fault_log = LogOnChange(_log, "the station's housekeeping failed; it is tried again")
    while not serving.done():
        await asyncio.to_thread(_run_housekeeping, housekeeping, fault_log)
        await asyncio.wait({serving}, timeout=_HOUSEKEEPING_S)
    await serving


def _run_housekeeping(housekeeping: Callable[[], None], fault_log: LogOnChange) -> None:
    try:
        with fault_log:
            housekeeping()
    except Exception:  # noqa: BLE001  # people are on the screen: the next time may do
        _log.exception("the station's housekeeping failed; it is tried again")


def bind(host: str, port: int) -> socket.socket:
    """Bind the port.  Raises ConfigError if another program uses it."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        bound = ConnectionLimitedSocket(family, kind, protocol)
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


def console_server(
    app: FastAPI,
    listening: socket.socket,
    http: HttpConfig,
    on_stop: Callable[[], None] = lambda: None,
) -> ConsoleServer:
    """Server of a console, with its settings; addresses of logged-in users may have more
    connections.
    """
    return ConsoleServer(
        app,
        listening,
        http.certificate,
        http.private_key,
        on_stop=on_stop,
        is_known=app.state.known_networks.__contains__,
    )
