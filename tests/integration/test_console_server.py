"""Start and end of the console's server."""

from __future__ import annotations

import asyncio

import pytest
from starlette.applications import Starlette

from base_station.api.server import ConsoleServer, bind, serve_until_stopped
from tests.rig.pacing import PATIENCE_S


@pytest.mark.parametrize("after_s", [None, 0.0, 0.005, 0.01, 0.02, 0.05])
async def test_server_stopped_during_its_start_ends_normally(after_s: float | None) -> None:
    """A station that hears of another one that leads as soon as it listens starts again."""
    stated: list[str] = []
    server = ConsoleServer(Starlette(), bind("127.0.0.1", 0))
    if after_s is None:
        server.stop()
    else:
        asyncio.get_running_loop().call_later(after_s, server.stop)
    async with asyncio.timeout(PATIENCE_S):
        await serve_until_stopped(server, stated.append)
    assert stated in ([], [f"ready {server.address}"])


async def test_invalid_requests_are_refused_and_logged_once(
    caplog: pytest.LogCaptureFixture,
) -> None:
    server = ConsoleServer(Starlette(), bind("127.0.0.1", 0))
    host, port = server.address.removeprefix("http://").split(":")
    serving = asyncio.create_task(server.serve())
    nonsense = b"\x00 nonsense\r\n\r\n"
    async with asyncio.timeout(PATIENCE_S):
        await server.wait_started()
        answers = [await _answer_to(nonsense, host, int(port)) for _ in range(20)]
        server.stop()
        await serving
    assert all(one.startswith(b"HTTP/1.1 400 ") for one in answers)
    assert [one.getMessage() for one in caplog.records] == ["Invalid HTTP request received."]


async def _answer_to(asked: bytes, host: str, port: int) -> bytes:
    reader, writer = await asyncio.open_connection(host, port)
    writer.write(asked)
    answer = await reader.read()
    writer.close()
    return answer
