"""Relay between a unit's connection and the router's."""

from __future__ import annotations

import asyncio
import socket
import ssl
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from base_station.security.router.internal_authority import InternalAuthority, load_identity
from base_station.security.router.relay import Relay

PATIENCE_S = 60.0
LAST_WORDS = b"position and stopped" * 5_000  # fits into the buffers of a connection
QUERY = b"what is in your journal" * 2_000


def tls_pair(closing: ExitStack) -> tuple[ssl.SSLSocket, ssl.SSLSocket]:
    """Blocking client and non-blocking server of one TCP connection on loopback."""
    authority = InternalAuthority()
    server_context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    server_context.num_tickets = 0
    load_identity(server_context, authority.router)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        client = socket.create_connection(listening.getsockname())
        server, _ = listening.accept()
    client_context = authority.client_context("anna")
    client.setblocking(False)
    server.setblocking(False)
    ends = (
        client_context.wrap_socket(client, do_handshake_on_connect=False),
        server_context.wrap_socket(server, server_side=True, do_handshake_on_connect=False),
    )
    finished = [False, False]
    while not all(finished):
        for index, end in enumerate(ends):
            try:
                end.do_handshake()
                finished[index] = True
            except ssl.SSLWantReadError:
                continue
    client_end, server_end = ends
    client_end.settimeout(PATIENCE_S)
    for one in ends:
        closing.callback(one.close)
    return client_end, server_end


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def read_to_end(connection: ssl.SSLSocket) -> bytes:
    received = b""
    while data := connection.recv(65_536):
        received += data
    return received


@pytest.mark.asyncio
@pytest.mark.parametrize("router_writes", [False, True], ids=["quiet router", "router writes"])
async def test_relay_forwards_data_sent_before_the_unit_closed(
    closing: ExitStack, *, router_writes: bool
) -> None:
    """A unit that has closed refuses what the router still writes to it."""
    unit, unit_side = tls_pair(closing)
    router, router_side = tls_pair(closing)
    ended = asyncio.Event()
    relay = Relay(asyncio.get_running_loop(), (unit_side, router_side), ended.set)
    if router_writes:
        router.sendall(QUERY)
    unit.sendall(LAST_WORDS)
    unit.close()
    relay.start()
    received = await asyncio.to_thread(read_to_end, router)
    assert received == LAST_WORDS
    router.close()
    await asyncio.wait_for(ended.wait(), PATIENCE_S)
    assert not relay.is_open


@pytest.mark.asyncio
async def test_relay_with_one_closed_end_closes(
    closing: ExitStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.security.router.relay._HALF_CLOSED_S", 0.1)
    unit, unit_side = tls_pair(closing)
    router, router_side = tls_pair(closing)
    ended = asyncio.Event()
    relay = Relay(asyncio.get_running_loop(), (unit_side, router_side), ended.set)
    relay.start()
    router.close()
    await asyncio.wait_for(ended.wait(), PATIENCE_S)
    assert await asyncio.to_thread(read_to_end, unit) == b""
