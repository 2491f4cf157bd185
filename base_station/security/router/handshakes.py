"""TLS handshakes that wait for no other: on non-blocking sockets in an asyncio loop.

asyncio's own TLS copies every byte through Python twice; for what passes through here its sockets
are used directly.
"""

from __future__ import annotations

import asyncio
import socket
import ssl
from contextlib import ExitStack

from base_station.security.router.admission import ConnectionAdmission
from base_station.security.router.internal_authority import load_identity
from base_station.security.router.pending import RoundRobin


def server_context(admission: ConnectionAdmission) -> ssl.SSLContext:
    """Context that requires a certificate of the authority.

    Sessions are not resumed: a resumed session would need no certificate.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.verify_mode = ssl.CERT_REQUIRED
    context.load_verify_locations(cadata=admission.identity.authority.decode("ascii"))
    context.options |= ssl.OP_NO_TICKET
    context.num_tickets = 0
    load_identity(context, admission.identity)
    return context


def holder_of(secured: ssl.SSLSocket) -> tuple[str, float]:
    """Common name (empty: it has none) and end (UTC, seconds) of the verified certificate."""
    certificate = secured.getpeercert() or {}
    subject = {str(part[0][0]): str(part[0][1]) for part in certificate.get("subject", ())}
    ends = str(certificate.get("notAfter", ""))
    return subject.get("commonName", ""), float(ssl.cert_time_to_seconds(ends)) if ends else 0.0


async def readable(connection: socket.socket) -> None:
    """Wait until the connection has bytes to read or was closed by the other end."""
    await _ready(connection, writing=False)


async def accept_secure(
    connection: socket.socket, context: ssl.SSLContext, round_robin: RoundRobin, network: str
) -> ssl.SSLSocket:
    """Make the handshake of an accepted connection, which the result owns from then on.

    Raises OSError (``ssl.SSLError`` is one).
    """
    await round_robin.wait(network)
    secured = context.wrap_socket(connection, server_side=True, do_handshake_on_connect=False)
    with ExitStack() as undo:
        undo.callback(secured.close)
        while (waits_for := _continue_handshake(secured)) is not None:
            await _ready(secured, writing=waits_for == "write")
            await round_robin.wait(network)
        undo.pop_all()
    return secured


async def connect_secure(
    port: int, context: ssl.SSLContext, buffer_bytes: int | None
) -> ssl.SSLSocket:
    """Connect to the router on this machine.  Raises OSError."""
    with ExitStack() as undo:
        connection = undo.enter_context(socket.socket())
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if buffer_bytes is not None:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
        await asyncio.get_running_loop().sock_connect(connection, ("127.0.0.1", port))
        secured = undo.enter_context(context.wrap_socket(connection, do_handshake_on_connect=False))
        while (waits_for := _continue_handshake(secured)) is not None:
            await _ready(secured, writing=waits_for == "write")
        undo.pop_all()
    return secured


def _continue_handshake(secured: ssl.SSLSocket) -> str | None:
    """Continue the handshake; returns the event that it waits for."""
    try:
        secured.do_handshake()
    except ssl.SSLWantReadError:
        return "read"
    except ssl.SSLWantWriteError:
        return "write"
    return None


async def _ready(connection: socket.socket, *, writing: bool) -> None:
    loop, file = asyncio.get_running_loop(), connection.fileno()
    ready: asyncio.Future[None] = loop.create_future()

    def wake() -> None:
        if not ready.done():
            ready.set_result(None)

    (loop.add_writer if writing else loop.add_reader)(file, wake)
    try:
        await ready
    finally:
        (loop.remove_writer if writing else loop.remove_reader)(file)
