"""Content of a console in a replay, in a form that can be compared."""

from __future__ import annotations

from typing import Any

import msgspec

from base_station.engine.ports import Trails
from base_station.replay.player import Player
from base_station.storage.db.known_people import KnownPerson
from base_station.views.wire import ReplayView, Snapshot, TrailPoint

VIEW = ReplayView("i1", 0, 0, 0, 1.0, playing=False)


def people(person_id: str) -> KnownPerson:
    return KnownPerson(f"Name of {person_id}", "blue", "leader", f"/photos/{person_id}")


def shown_at(player: Player, t_ns: int) -> tuple[dict[str, Any], dict[str, list[TrailPoint]]]:
    for _ in player.seek(t_ns):
        pass
    assert not player.is_lost
    return plain(*player.snapshot(VIEW))


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
