"""The console's server as it begins and ends."""

from __future__ import annotations

import asyncio

import pytest
from starlette.applications import Starlette

from base_station.api.server import ConsoleServer, bind, serve_until_stopped


@pytest.mark.parametrize("after_s", [None, 0.0, 0.005, 0.01, 0.02, 0.05])
async def test_stopped_as_it_begins_it_ends_in_order(after_s: float | None) -> None:
    """A station that hears of another one that leads as soon as it listens starts again."""
    said: list[str] = []
    server = ConsoleServer(Starlette(), bind("127.0.0.1", 0))
    if after_s is None:
        server.stop()
    else:
        asyncio.get_running_loop().call_later(after_s, server.stop)
    async with asyncio.timeout(20.0):
        await serve_until_stopped(server, said.append)
    assert said in ([], [f"ready {server.address}"])
