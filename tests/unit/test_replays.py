"""The replays that consoles have open: bounded, and ended when nobody looks."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from base_station.api.hub import Hub
from base_station.api.replays import MOST_REPLAYS, UNWATCHED_S, Replays
from base_station.api.wire import ReplayView, Snapshot
from base_station.db.models import Incident
from base_station.live.sinks import Trails
from shared.errors import UserError


class Player:
    def __init__(self) -> None:
        self.closed = False
        self.is_over = False

    def play(self) -> None: ...

    def pause(self) -> None: ...

    def seek(self, t_ns: int) -> None: ...

    def set_speed(self, speed: float) -> None: ...

    def view(self) -> ReplayView:
        return ReplayView("i-1", 0, 1, 0, 1.0, playing=True)

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None: ...

    def close(self) -> None:
        self.closed = True


INCIDENT = Incident(incident_id="i-1", name="Kitchen", opened_ns=0)


async def test_a_replay_that_nobody_looks_at_ends() -> None:
    clock = [0.0]
    replays = Replays(lambda *_: Player(), monotonic_s=lambda: clock[0])
    loop = asyncio.get_running_loop()
    watched = replays.open(INCIDENT, 1.0, loop)
    left = replays.open(INCIDENT, 1.0, loop)
    lasting = replays.open(INCIDENT, 1.0, loop, lasting=Hub())
    watched.hub.join()
    clock[0] = UNWATCHED_S - 1.0
    replays.close_unwatched()
    assert len(replays.all()) == 3
    clock[0] = UNWATCHED_S + 1.0
    replays.close_unwatched()
    assert {one.replay_id for one in replays.all()} == {watched.replay_id, lasting.replay_id}
    assert left.player.closed  # type: ignore[attr-defined]  # it is a Player
    assert replays.get(left.replay_id) is None
    watched.player.is_over = True  # type: ignore[misc]  # it is a Player
    replays.close_unwatched()
    assert replays.all() == (lasting,)
    replays.close_all()
    assert replays.all() == ()


async def test_there_are_only_so_many() -> None:
    replays = Replays(lambda *_: Player())
    loop = asyncio.get_running_loop()
    for _ in range(MOST_REPLAYS):
        replays.open(INCIDENT, 1.0, loop)
    with pytest.raises(UserError, match="close one"):
        replays.open(INCIDENT, 1.0, loop)
    replays.close(replays.all()[0].replay_id)
    replays.open(INCIDENT, 1.0, loop)
