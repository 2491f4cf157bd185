"""Replays that consoles have open; each has its own hub and its own pipeline."""

from __future__ import annotations

import asyncio
import secrets
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from base_station.api.hub import Hub
from base_station.engine.ports import LiveSource
from base_station.storage.db.models import IncidentRow
from base_station.views.wire import ReplayView
from shared.coded_text import coded
from shared.errors import UserError

MAX_REPLAYS = 8
UNWATCHED_S = 60.0  # a replay without a viewer ends


class ReplayPlayer(LiveSource, Protocol):
    """Player of one replay.  Thread-safe."""

    def play(self) -> None: ...

    def pause(self) -> None: ...

    def seek(self, t_ns: int) -> None: ...

    def set_speed(self, speed: float) -> None: ...

    def view(self) -> ReplayView: ...

    @property
    def is_over(self) -> bool:
        """True once it was closed or has failed."""
        ...

    def close(self) -> None:
        """Stop and join its thread."""
        ...


StartReplay = Callable[[IncidentRow, float, Hub], ReplayPlayer]  # incident, speed, its hub


@dataclass
class OpenReplay:
    replay_id: str
    hub: Hub
    player: ReplayPlayer
    begun_by: str  # a user; empty: the station itself
    persistent: bool  # stays without a viewer
    last_watched_s: float  # time at which it last had a viewer


class Replays:
    """Open replays.  Thread-safe."""

    def __init__(
        self, start: StartReplay, monotonic_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._start = start
        self._monotonic_s = monotonic_s
        self._open: dict[str, OpenReplay] = {}
        self._lock = threading.Lock()

    def open(
        self,
        incident: IncidentRow,
        speed: float,
        loop: asyncio.AbstractEventLoop,
        begun_by: str,
        persistent: Hub | None = None,
    ) -> OpenReplay:
        """Start a replay.  One for which a hub is given lasts until it is closed."""
        self._require_room()
        hub = persistent or Hub()
        player = self._start(incident, speed, hub)  # may wait for an archive; requests do not
        opened = OpenReplay(
            secrets.token_hex(8),
            hub,
            player,
            begun_by,
            persistent is not None,
            self._monotonic_s(),
        )
        try:
            with self._lock:
                self._require_room()
                self._open[opened.replay_id] = opened
        except UserError:
            player.close()
            raise
        loop.call_soon_threadsafe(hub.connect, loop, player)
        return opened

    def _require_room(self) -> None:
        if len(self._open) >= MAX_REPLAYS:
            raise UserError(
                coded(
                    "replays-too-many",
                    "{most} replays are open already; end one of them",
                    most=MAX_REPLAYS,
                )
            )

    def get(self, replay_id: str) -> OpenReplay | None:
        with self._lock:
            return self._open.get(replay_id)

    def all(self) -> Sequence[OpenReplay]:
        with self._lock:
            return tuple(self._open.values())

    def close(self, replay_id: str) -> bool:
        with self._lock:
            closed = self._open.pop(replay_id, None)
        if closed is not None:
            closed.player.close()
        return closed is not None

    def close_unwatched(self) -> None:
        """Close replays that have failed, or that no console has shown for a while; to be called
        regularly.
        """
        now_s = self._monotonic_s()
        for replay in self.all():
            if replay.player.is_over:
                self.close(replay.replay_id)
            elif replay.hub.watchers or replay.persistent:
                replay.last_watched_s = now_s
            elif now_s - replay.last_watched_s > UNWATCHED_S:
                self.close(replay.replay_id)

    def close_all(self) -> None:
        for replay in self.all():
            self.close(replay.replay_id)
