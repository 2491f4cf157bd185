"""Idle connections end, and take no place of others."""

from __future__ import annotations

import asyncio
import resource
import ssl
from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import pytest_asyncio
from starlette.requests import ClientDisconnect, Request
from starlette.responses import PlainTextResponse
from starlette.types import Receive, Scope, Send

from base_station.api import connections, server
from base_station.api.server import ConsoleServer, bind
from base_station.process.open_files import allow_many_files
from base_station.security.networks import network_of
from base_station.security.pki.certificates import issue, make_authority
from shared.enrolment import Holder
from tests.rig.waiting import PATIENCE_S

GET = b"GET / HTTP/1.1\r\nHost: x\r\n"
UPGRADE = (
    b" HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
)
Stream = tuple[asyncio.StreamReader, asyncio.StreamWriter]
STRANGERS: set[str] = set()  # places from which nobody is logged in


async def answer_what_was_read(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "http":
        try:
            await Request(scope, receive).body()
        except ClientDisconnect:
            return
        asks = f"{scope['client'][0]} {scope['scheme']} " if scope["path"] == "/who" else ""
        await PlainTextResponse(f"{asks}here")(scope, receive, send)
    elif scope["type"] == "websocket":
        taken = scope["path"] != "/refused"
        await send({"type": "websocket.accept" if taken else "websocket.close"})
        while taken and (await receive())["type"] != "websocket.disconnect":
            pass


@pytest.fixture
def bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "_REQUEST_TIMEOUT_S", 1.0)
    monkeypatch.setattr(server, "_BODY_TIMEOUT_S", 1.0)
    monkeypatch.setattr(connections, "MAX_PER_NETWORK", 5)


@pytest_asyncio.fixture
async def port(bounds: None) -> AsyncIterator[int]:
    async for one in served():
        yield one


@pytest_asyncio.fixture
async def secure_port(bounds: None, tmp_path: Path) -> AsyncIterator[int]:
    now, day = datetime.now(UTC), timedelta(days=1)
    issued = issue(make_authority("Test", now, 2 * day), "station", Holder.STATION, now, day)
    certificate, key = tmp_path / "station.pem", tmp_path / "station.key"
    certificate.write_bytes(issued.certificate_pem())
    key.write_bytes(issued.key_pem())
    async for one in served(certificate, key):
        yield one


async def served(*identity: Path) -> AsyncIterator[int]:
    listening = bind("127.0.0.1", 0)
    serving = ConsoleServer(
        answer_what_was_read, listening, *identity, is_known=lambda place: place not in STRANGERS
    )
    task = asyncio.create_task(serving.serve())
    await serving.wait_started()
    yield listening.getsockname()[1]
    serving.stop()
    await task


async def connect(
    port: int, place: str = "127.0.0.1", secured: ssl.SSLContext | None = None
) -> Stream:
    return await asyncio.open_connection("127.0.0.1", port, local_addr=(place, 0), ssl=secured)


def trusting() -> ssl.SSLContext:
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


async def answer_of(stream: Stream) -> bytes:
    return (await stream[0].readuntil(b"here"))[:15]


async def asked(port: int) -> bytes:
    """The answer to a question on a connection of its own; empty: it was let go."""
    stream = await connect(port)
    try:
        stream[1].write(GET + b"\r\n")
        return await answer_of(stream)
    except (asyncio.IncompleteReadError, ConnectionError):
        return b""
    finally:
        stream[1].close()


async def test_connection_without_a_complete_request_is_closed(port: int) -> None:
    nothing, half, slow = [await connect(port) for _ in range(3)]
    half[1].write(GET)
    slow[1].write(GET + b"\r\n")
    assert await answer_of(slow) == b"HTTP/1.1 200 OK"
    slow[1].write(GET)  # half a second question on a connection that was good
    for stream in (nothing, half, slow):
        async with asyncio.timeout(PATIENCE_S):
            assert await stream[0].read() == b""
        stream[1].close()


async def test_connection_with_a_stalled_body_is_closed(port: int) -> None:
    whole, half = [await connect(port) for _ in range(2)]
    for stream in (whole, half):
        stream[1].write(GET.replace(b"GET", b"POST") + b"Content-Length: 4\r\n\r\nhe")
    whole[1].write(b"re")
    assert await answer_of(whole) == b"HTTP/1.1 200 OK"
    async with asyncio.timeout(PATIENCE_S):
        assert await half[0].read() == b""
    for stream in (whole, half):
        stream[1].close()


async def test_connection_with_a_very_slow_body_is_closed(port: int) -> None:
    """Each of them is progress, and none is enough."""
    drip = await connect(port)
    drip[1].write(GET.replace(b"GET", b"POST") + b"Content-Length: 1000\r\n\r\n")
    sent = 0
    async with asyncio.timeout(PATIENCE_S):
        while not drip[0].at_eof() and not drip[1].is_closing():
            drip[1].write(b" ")
            sent += 1
            await asyncio.sleep(0.1)
    assert sent < 100  # of a thousand
    drip[1].close()


async def test_new_connection_is_accepted_when_all_are_taken(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The oldest one of the largest network is closed; networks with a login keep theirs."""
    monkeypatch.setattr(connections, "MAX_ANONYMOUS", 6)
    monkeypatch.setattr(connections, "MAX_PER_ANONYMOUS_NETWORK", 4)
    monkeypatch.setattr(server, "_REQUEST_TIMEOUT_S", 1000.0)
    monkeypatch.setattr(f"{__name__}.STRANGERS", {f"127.0.0.{number}" for number in range(2, 6)})
    known = await connect(port, "127.0.0.9")
    greedy = [await connect(port, "127.0.0.2") for _ in range(5)]
    async with asyncio.timeout(PATIENCE_S):
        assert await greedy[4][0].read() == b""  # one place has four
    others = [await connect(port, f"127.0.0.{number}") for number in (3, 4, 5)]
    async with asyncio.timeout(PATIENCE_S):
        assert await greedy[0][0].read() == b""
    for one in (*greedy[1:4], *others, known):
        one[1].write(GET + b"\r\n")
        assert await answer_of(one) == b"HTTP/1.1 200 OK"
    for one in (known, *greedy, *others):
        one[1].close()


async def test_closed_or_open_websocket_has_no_request_timeout(secure_port: int) -> None:
    """Nor is one that goes on: what it says is not waited for."""
    troubles: list[object] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, reported: troubles.append(reported))
    refused, open_one = [await connect(secure_port, secured=trusting()) for _ in range(2)]
    for path, stream in ((b"/refused", refused), (b"/", open_one)):
        stream[1].write(b"GET " + path + UPGRADE)
    assert (await refused[0].read()).startswith(b"HTTP/1.1 403")
    refused[1].close()
    assert (await open_one[0].readuntil(b"\r\n\r\n")).startswith(b"HTTP/1.1 101")
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(2.0 * server._REQUEST_TIMEOUT_S):
            await open_one[0].read()
    open_one[1].close()
    assert troubles == []


async def test_connections_of_a_network_are_limited(port: int) -> None:
    streams = [await connect(port) for _ in range(8)]
    for _, writer in streams:
        writer.write(GET + b"\r\n")
    answers = await asyncio.gather(*map(answer_of, streams), return_exceptions=True)
    assert sum(isinstance(one, bytes) for one in answers) == 5
    elsewhere = await connect(port, "127.0.0.2")
    elsewhere[1].write(GET + b"\r\n")
    assert await answer_of(elsewhere) == b"HTTP/1.1 200 OK"
    for _, writer in (*streams, elsewhere):
        writer.close()
    async with asyncio.timeout(PATIENCE_S):  # until the server has seen them go
        while not (answer := await asked(port)):
            await asyncio.sleep(0.02)
    assert answer == b"HTTP/1.1 200 OK"


async def test_unfinished_tls_handshake_is_closed(secure_port: int) -> None:
    streams = [await connect(secure_port) for _ in range(2)]
    streams[1][1].write(b"\x16\x03\x01")  # and no more of it
    for reader, writer in streams:
        async with asyncio.timeout(PATIENCE_S):
            assert await reader.read() == b""
        writer.close()


async def test_unfinished_tls_handshakes_count_as_connections(
    secure_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each takes more of the station's memory than who asks."""
    monkeypatch.setattr(server, "_REQUEST_TIMEOUT_S", 1000.0)
    held = [await connect(secure_port) for _ in range(5)]
    with pytest.raises((ssl.SSLError, ConnectionError)):
        await connect(secure_port, secured=trusting())
    elsewhere = await connect(secure_port, "127.0.0.2", trusting())
    elsewhere[1].write(GET + b"\r\n")
    assert await answer_of(elsewhere) == b"HTTP/1.1 200 OK"
    for _, writer in (*held, elsewhere):
        writer.close()


async def test_total_of_connections_is_limited(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "MAX_CONNECTIONS", 3)
    streams = [await connect(port, f"127.0.0.{number}") for number in range(1, 6)]
    for _, writer in streams:
        writer.write(GET + b"\r\n")
    answers = await asyncio.gather(*map(answer_of, streams), return_exceptions=True)
    assert sum(isinstance(one, bytes) for one in answers) == 3
    for _, writer in streams:
        writer.close()


async def test_client_address_is_of_the_connection_not_of_a_header(port: int) -> None:
    stream = await connect(port)
    stated = b"X-Forwarded-For: 192.0.2.1\r\nX-Forwarded-Proto: https\r\n\r\n"
    stream[1].write(GET.replace(b"/ ", b"/who ") + stated)
    answer = await stream[0].readuntil(b"here")
    assert b"127.0.0.1 http here" in answer
    stream[1].close()


def test_ipv6_network_counts_as_one_client() -> None:
    assert network_of("2001:db8:1:2::1") == network_of("2001:db8:1:2:3:4:5:6")
    assert network_of("2001:db8:1:2::1") != network_of("2001:db8:1:3::1")
    assert network_of("192.0.2.1") != network_of("192.0.2.2")


def test_file_limit_is_raised_for_connections() -> None:
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(256, before[1]), before[1]))
    try:
        allow_many_files()
        assert resource.getrlimit(resource.RLIMIT_NOFILE) == (before[1], before[1])
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
