"""A station continues when its housekeeping fails, and ends at a signal."""

from __future__ import annotations

import asyncio
import os
import signal

import pytest
from starlette.types import Receive, Scope, Send

from base_station.api.server import ConsoleServer, bind, serve_until_stopped
from shared.errors import StoreError


async def nothing(_scope: Scope, _receive: Receive, _send: Send) -> None:
    """No application: nobody asks it anything."""


async def test_a_failure_is_reported_and_tried_again(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("base_station.api.server._HOUSEKEEPING_S", 0.01)
    # This process goes on.
    monkeypatch.setattr("base_station.process.gc_tuning.freeze", lambda: None)
    tries = 0

    def keep_house() -> None:
        nonlocal tries
        tries += 1
        if tries == 3:
            os.kill(os.getpid(), signal.SIGTERM)
        raise StoreError("the database cannot be read")

    reported: list[str] = []
    server = ConsoleServer(nothing, bind("127.0.0.1", 0))
    async with asyncio.timeout(20.0):
        await serve_until_stopped(server, reported.append, keep_house)
    assert tries >= 3
    assert [line.split()[0] for line in reported] == ["ready"]
    assert "the database cannot be read" in caplog.text
