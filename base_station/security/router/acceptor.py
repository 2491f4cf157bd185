"""Takes the bus's connections in front of the router, and hands on those of enrolled holders.

Zenoh makes one TLS handshake after the other: a client that is silent, or fails, delays all behind
it.  Here they are made side by side, bounded in number and time, and the router gets a connection
only when its holder has shown a valid certificate and has sent its first bytes.
"""

from __future__ import annotations

import asyncio
import errno
import logging
import resource
import socket
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from threading import Thread

from base_station.security.networks import network_of
from base_station.security.router.admission import ConnectionAdmission
from base_station.security.router.handshakes import (
    accept_secure,
    connect_secure,
    readable,
    server_context,
)
from base_station.security.router.internal_authority import InternalAuthority
from base_station.security.router.links import Links, RelayedLink
from base_station.security.router.listening import listen_on
from base_station.security.router.pending import PendingConnections, RoundRobin
from base_station.security.router.refusals import Refusal, Refusals, RefusalSummary, RefusedError
from base_station.security.router.relay import Relay

logger = logging.getLogger(__name__)

_ACCEPTS_PER_WAKEUP = 64
_HANDSHAKE_TIMEOUT_S = 10.0  # from the connection to the first bytes behind the handshake
_ROUTER_TIMEOUT_S = 10.0  # while it opens again
_MAX_PENDING = 2000
_PENDING_SHARE = 4  # of the files that a process may open, one in so many
_CHECK_EVERY_S = 1.0
_NO_FILES_PAUSE_S = 0.1
_LOG_EVERY_S = 60.0
_OUT_OF_FILES = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)


class Acceptor:
    """Thread that listens from the making of this object until ``close``."""

    def __init__(
        self, listen: Sequence[str], admission: ConnectionAdmission, authority: InternalAuthority
    ) -> None:
        """Raises BusError where it cannot listen."""
        self._sockets = listen_on(listen)
        self._loop = asyncio.new_event_loop()
        self._context, self._identity = server_context(admission), admission.identity
        self._links = Links(admission, authority)
        self._router_port = 0
        self._router_is_open = asyncio.Event()
        self._round_robin = RoundRobin(self._loop)
        soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        self._pending = PendingConnections(min(_MAX_PENDING, soft // _PENDING_SHARE))
        self._evicted: set[asyncio.Task[None]] = set()  # that had to go
        self._refusals = Refusals()
        self._logged_s = self._loop.time()
        self._thread = Thread(target=self._run, name="acceptor", daemon=True)
        self._thread.start()

    def set_admission(self, admission: ConnectionAdmission) -> None:
        """Set the holders that may connect; links of holders that are not enrolled any more end."""
        self._loop.call_soon_threadsafe(self._set_admission, admission)

    def route_to(self, port: int | None) -> None:
        """Set the port of the router on this machine; None while it is down."""
        self._loop.call_soon_threadsafe(self._route_to, port)

    def ban(self, common_name: str, seconds: float) -> None:
        """End the links of a holder, and refuse new ones for so many seconds."""
        self._loop.call_soon_threadsafe(self._ban, common_name, seconds)

    def refused(self) -> RefusalSummary:
        return asyncio.run_coroutine_threadsafe(self._summary(), self._loop).result()

    def close(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    # ---- in the loop's thread

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        for listening in self._sockets:
            self._loop.add_reader(listening.fileno(), self._accept, listening)
        self._loop.call_later(_CHECK_EVERY_S, self._check)
        try:
            self._loop.run_forever()
        finally:
            self._end()

    def _end(self) -> None:
        for listening in self._sockets:
            self._loop.remove_reader(listening.fileno())
            listening.close()
        self._links.close()
        tasks = asyncio.all_tasks(self._loop)
        for task in tasks:
            task.cancel()
        self._loop.run_until_complete(asyncio.gather(*tasks, return_exceptions=True))
        self._loop.close()

    def _set_admission(self, admission: ConnectionAdmission) -> None:
        if admission.identity != self._identity:
            self._context, self._identity = server_context(admission), admission.identity
        self._links.set_admission(admission)

    def _route_to(self, port: int | None) -> None:
        self._router_port = port or 0
        if port is None:
            self._router_is_open.clear()
        else:
            self._router_is_open.set()

    def _ban(self, common_name: str, seconds: float) -> None:
        self._links.ban(common_name, self._loop.time() + seconds)

    async def _summary(self) -> RefusalSummary:
        return self._refusals.summary(self._loop.time())

    def _check(self) -> None:
        """End links whose certificates have expired, and log refused connections."""
        self._loop.call_later(_CHECK_EVERY_S, self._check)
        self._links.end_expired()
        if self._loop.time() - self._logged_s < _LOG_EVERY_S:
            return
        self._logged_s = self._loop.time()
        refused = self._refusals.summary(self._logged_s)
        if refused.in_window:
            logger.warning(
                "refused %d connections in a minute, %d of them from %s, mostly for: %s",
                *(refused.in_window, refused.of_network, refused.network, refused.reason),
            )

    def _accept(self, listening: socket.socket) -> None:
        for _ in range(_ACCEPTS_PER_WAKEUP):
            try:
                connection, address = listening.accept()
            except BlockingIOError:
                return
            except OSError as error:
                if error.errno in _OUT_OF_FILES:
                    self._free_files(listening)
                    return
                continue  # of a connection that has ended meanwhile
            connection.setblocking(False)
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            network = network_of(address[0])
            task = self._loop.create_task(self._serve(connection, network))
            self._evict(self._pending.add(network, task))

    def _free_files(self, listening: socket.socket) -> None:
        """Close the oldest pending connection, and accept again after a pause: this process may not
        open more files.
        """
        self._evict(self._pending.oldest())
        self._loop.remove_reader(listening.fileno())
        resume = partial(self._loop.add_reader, listening.fileno(), self._accept, listening)
        self._loop.call_later(_NO_FILES_PAUSE_S, resume)

    def _evict(self, task: asyncio.Task[None] | None) -> None:
        if task is not None:
            self._evicted.add(task)
            task.add_done_callback(self._evicted.discard)
            task.cancel()

    async def _serve(self, connection: socket.socket, network: str) -> None:
        """Serve one connection until its link is relayed or refused."""
        task = asyncio.current_task()
        assert task is not None
        try:
            async with asyncio.timeout(_HANDSHAKE_TIMEOUT_S):
                link = await self._authenticate(connection, network, task)
            self._pending.remove(network, task)
            await self._connect(link)
        except RefusedError as refused:
            self._refuse(refused.reason, network)
        except TimeoutError:
            self._refuse(Refusal.SILENT, network)
        except asyncio.CancelledError:
            if task not in self._evicted:  # the acceptor ends
                raise
            self._refuse(Refusal.EVICTED, network)
        except OSError:
            self._refuse(Refusal.NOT_TLS, network)
        finally:
            connection.close()  # does nothing where a handshake has taken it over
            self._pending.remove(network, task)

    def _refuse(self, reason: Refusal, network: str) -> None:
        self._refusals.add(reason, network, self._loop.time())

    async def _authenticate(
        self, connection: socket.socket, network: str, task: asyncio.Task[None]
    ) -> RelayedLink:
        """Make the handshake once the first bytes have come; a silent connection costs nothing."""
        await readable(connection)
        if not connection.recv(1, socket.MSG_PEEK):
            raise RefusedError(Refusal.ENDED)
        secured = await accept_secure(connection, self._context, self._round_robin, network)
        with ExitStack() as undo:
            undo.callback(secured.close)
            link = self._links.add(secured, task, self._loop.time())
            undo.callback(link.close)
            await readable(secured)
            undo.pop_all()
        return link

    async def _connect(self, link: RelayedLink) -> None:
        """Hand the link on to the router, for which it waits while the router restarts."""
        with ExitStack() as undo:
            undo.callback(link.secured.close)
            undo.callback(link.close)
            try:
                async with asyncio.timeout(_ROUTER_TIMEOUT_S):
                    await self._router_is_open.wait()
                    context, buffer_bytes = self._links.router_connection_settings(link.common_name)
                    router = await connect_secure(self._router_port, context, buffer_bytes)
            except OSError as error:  # TimeoutError is one
                logger.debug("the router takes no link of %s: %s", link.common_name, error)
                return
            undo.pop_all()
        link.relay = Relay(self._loop, (link.secured, router), link.close)
        link.relay.start()
