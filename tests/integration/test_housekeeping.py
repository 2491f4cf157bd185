"""A station continues when its housekeeping fails, and lists its segments when it ends."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from starlette.types import Receive, Scope, Send

from base_station.api.server import ConsoleServer, bind, serve_until_stopped
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.errors import StoreError
from shared.mcap_log import segment_paths
from tests.rig.station_command import Command
from tests.rig.waiting import until


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


def test_segments_completed_since_the_last_round_are_listed_at_the_end(
    serve: Callable[..., Command], data: Path, tmp_path: Path
) -> None:
    settings = tmp_path / "station.toml"
    settings.write_text("[log]\nsegment_s = 1.0\n")
    station = serve("--config", str(settings))
    station.wait_ready()
    until(lambda: len(segment_paths(data / "log")) > 3)
    complete = {path.name for path in segment_paths(data / "log")[:-1]}
    assert station.stop() == 0
    with Store(data / "station.sqlite") as store:
        listed = {one.name for one in Records(store, SystemClock()).segments()}
    assert complete <= listed
