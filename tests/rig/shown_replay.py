"""Content of a console in a replay, in a form that can be compared."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from base_station.engine.ports import Trails
from base_station.replay.player import Player
from base_station.storage.db.known_people import KnownPerson
from base_station.views.wire import ReplayView, Snapshot, TrailPoint
from tests.rig.waiting import PATIENCE_S

VIEW = ReplayView("i1", 0, 0, 0, 1.0, playing=False)


def people(person_id: str) -> KnownPerson:
    return KnownPerson(f"Name of {person_id}", "blue", "leader", f"/photos/{person_id}")


def shown_at(player: Player, t_ns: int) -> tuple[dict[str, Any], dict[str, list[TrailPoint]]]:
    for _ in player.seek(t_ns):
        pass
    assert not player.is_lost
    return plain(*player.snapshot(VIEW))


class SnapshotSource(Protocol):
    """A replay, in this process or in one of its own."""

    def request_snapshot(self, take: Callable[[Snapshot, Trails], None], /) -> None: ...


def requested_snapshot(replay: SnapshotSource) -> Snapshot:
    """The snapshot that the replay gives on request, waiting for it."""
    found: list[Snapshot] = []
    came = threading.Event()

    def take(snapshot: Snapshot, _: Trails) -> None:
        found.append(snapshot)
        came.set()

    replay.request_snapshot(take)
    assert came.wait(PATIENCE_S)
    return found[0]


def plain(snapshot: Snapshot, trails: Trails) -> tuple[dict[str, Any], dict[str, list[TrailPoint]]]:
    shown = msgspec.json.decode(msgspec.json.encode(snapshot))
    del shown["seq"]
    shown["alarms"].sort(key=lambda alarm: alarm["alarm_id"])  # a console has an order of its own
    for unit in shown["units"]:
        unit["alarms"].sort()
    drawn = {
        unit_id: msgspec.json.decode(points, type=list[TrailPoint])
        for unit_id, points in trails.items()
    }
    return shown, drawn
