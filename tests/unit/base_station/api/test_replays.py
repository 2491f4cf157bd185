"""Replays of consoles: bounded in number, and ended when no console reads them."""

from __future__ import annotations

import asyncio

import pytest

from base_station.api.hub import Hub
from base_station.api.replays import MAX_REPLAYS, UNWATCHED_S, Replays
from base_station.storage.db.models import IncidentRow
from shared.errors import UserError
from tests.rig.recording_replay import NotedReplay

INCIDENT = IncidentRow(incident_id="i-1", name="Kitchen", opened_ns=0)


async def test_replay_without_viewer_ends() -> None:
    clock = [0.0]
    replays = Replays(lambda *_: NotedReplay(), monotonic_s=lambda: clock[0])
    loop = asyncio.get_running_loop()
    watched = replays.open(INCIDENT, 1.0, loop, "mia")
    left = replays.open(INCIDENT, 1.0, loop, "mia")
    persistent = replays.open(INCIDENT, 1.0, loop, "", persistent=Hub())
    watched.hub.join()
    clock[0] = UNWATCHED_S - 1.0
    replays.close_unwatched()
    assert len(replays.all()) == 3
    clock[0] = UNWATCHED_S + 1.0
    replays.close_unwatched()
    assert {one.replay_id for one in replays.all()} == {watched.replay_id, persistent.replay_id}
    assert left.player.closed  # type: ignore[attr-defined]  # it is a NotedReplay
    assert replays.get(left.replay_id) is None
    watched.player.is_over = True  # type: ignore[misc]  # it is a NotedReplay
    replays.close_unwatched()
    assert replays.all() == (persistent,)
    replays.close_all()
    assert replays.all() == ()


async def test_number_of_replays_is_bounded() -> None:
    replays = Replays(lambda *_: NotedReplay())
    loop = asyncio.get_running_loop()
    for _ in range(MAX_REPLAYS):
        replays.open(INCIDENT, 1.0, loop, "mia")
    with pytest.raises(UserError, match="end one"):
        replays.open(INCIDENT, 1.0, loop, "mia")
    replays.close(replays.all()[0].replay_id)
    replays.open(INCIDENT, 1.0, loop, "mia")
