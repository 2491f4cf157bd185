"""The HTTP server: uvicorn on a socket of our own, stopped by us."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import resource
import signal
import socket
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from base_station.api.networks import network_of
from base_station.program import interpreter
from base_station.program.recurring_trouble import RecurringTrouble
from base_station.program.said_seldom import SaidSeldom
from shared.clock import SystemClock
from shared.errors import ConfigError

_GRACE_S = 5
_HOUSEKEEPING_S = 5.0
_BACKLOG = 512
_LARGEST_REQUEST_BYTES = 4096  # over a WebSocket: all that is asked is a snapshot
_MOST_CONNECTIONS = 2000
_MOST_OF_ONE = 500  # place: a proxy, or two hundred consoles behind one router
_ASK_WITHIN_S = 10.0  # the head of a request, and before it the greeting of TLS
_GO_ON_WITHIN_S = 60.0  # with a body, for a radio that loses much


_log = logging.getLogger(__name__)
_SERVER_LOG = logging.getLogger("uvicorn.error")  # all that it says of requests


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        """Signals are the station's, which stops everything in order."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listens by itself: uvicorn leaves whoever begins a greeting of TLS a minute for it."""
        await super().startup(sockets=[])
        config = self.config

        def new_connection() -> _Connection:
            return _Connection(config, self.server_state, self.lifespan.state)

        for one in sockets or ():
            listener = await asyncio.get_running_loop().create_server(
                new_connection,
                sock=one,
                backlog=_BACKLOG,
                ssl=config.ssl,
                ssl_handshake_timeout=_ASK_WITHIN_S if config.ssl else None,
            )
            self.servers.append(listener)


class _Door(socket.socket):
    """Nobody takes all the station's connections.  They are counted from when they come in: over
    TLS it takes a while until one can ask anything, and all that while it takes memory.
    """

    def __init__(
        self, family: int = -1, kind: int = -1, protocol: int = -1, fileno: int | None = None
    ) -> None:
        super().__init__(family, kind, protocol, fileno)
        self._places: WeakKeyDictionary[socket.socket, str] = WeakKeyDictionary()

    def accept(self) -> tuple[socket.socket, Any]:
        """Raises ConnectionAbortedError in the place of one too many, which it lets go."""
        accepted, address = super().accept()
        for gone in [one for one in self._places if one.fileno() < 0]:
            del self._places[gone]
        place, places = network_of(address[0]), list(self._places.values())
        if len(places) >= _MOST_CONNECTIONS or places.count(place) >= _MOST_OF_ONE:
            accepted.close()
            raise ConnectionAbortedError
        self._places[accepted] = place
        return accepted, address


class _Connection(H11Protocol):
    """Nobody holds one without asking anything."""

    _deadline: asyncio.TimerHandle | None = None
    _is_websocket = False  # by now: another protocol minds it

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._mind_deadline()

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._mind_deadline()

    def handle_websocket_upgrade(self, event: Any) -> None:
        self._is_websocket = True  # this one does not hear when it ends
        self._end_deadline()
        super().handle_websocket_upgrade(event)

    def connection_lost(self, exc: Exception | None) -> None:
        self._end_deadline()
        super().connection_lost(exc)

    def _mind_deadline(self) -> None:
        if self._is_websocket:
            return
        answering = getattr(self.cycle, "response_complete", True) is False
        if answering:
            self._end_deadline()
        if answering and self.cycle.more_body:
            self._deadline = self.loop.call_later(_GO_ON_WITHIN_S, self._give_up)
        elif not answering and self._deadline is None:
            self._deadline = self.loop.call_later(_ASK_WITHIN_S, self._give_up)

    def _end_deadline(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _give_up(self) -> None:
        self._deadline = None
        if self.flow.read_paused:  # the station lets the body wait
            self._mind_deadline()
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
    ) -> None:
        """``on_stop`` is called when it is told to stop, and again when it is told again.

        Raises ConfigError where the certificate or its key cannot be used.
        """
        self._socket = listening
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
        self._seldom = SaidSeldom(SystemClock())

    async def serve(self) -> None:
        """Until ``stop``."""
        _SERVER_LOG.addFilter(self._seldom)
        try:
            await self._server.serve(sockets=[self._socket])
        finally:
            _SERVER_LOG.removeFilter(self._seldom)
            self._socket.close()

    async def wait_started(self) -> None:
        while not self._server.started:
            await asyncio.sleep(0.01)

    def stop(self) -> None:
        """From the loop's thread."""
        self._server.should_exit = True
        self._on_stop()


async def serve_until_stopped(
    server: ConsoleServer,
    announce: Callable[[str], None],
    housekeeping: Callable[[], None] = lambda: None,
) -> None:
    """Serve until SIGINT or SIGTERM, and say ``ready ADDRESS`` once consoles can connect.

    ``housekeeping`` is called now and then, in a thread; where it fails, the station goes on.
    """
    interpreter.settle()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, server.stop)
    serving = asyncio.create_task(server.serve())
    starting = asyncio.create_task(server.wait_started())
    await asyncio.wait({serving, starting}, return_when=asyncio.FIRST_COMPLETED)
    if starting.done() and not serving.done():  # it may have been stopped as it began
        announce(f"ready {server.address}")
    starting.cancel()
    trouble = RecurringTrouble(_log, "the station's housekeeping failed; it is tried again")
    while not serving.done():
        await asyncio.to_thread(_keep_house, housekeeping, trouble)
        await asyncio.wait({serving}, timeout=_HOUSEKEEPING_S)
    await serving


def _keep_house(housekeeping: Callable[[], None], trouble: RecurringTrouble) -> None:
    try:
        with trouble:
            housekeeping()
    except Exception:  # noqa: BLE001  # people are on the screen: the next time may do
        _log.exception("the station's housekeeping failed; it is tried again")


def allow_many_files() -> None:
    """As many as the machine allows: connections must not take them from the log."""
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


def bind(host: str, port: int) -> socket.socket:
    """Take the port; raises ConfigError where another program has it."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        bound = _Door(family, kind, protocol)
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
