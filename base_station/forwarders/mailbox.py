"""Mailbox between the engine's thread and the thread of a forwarder.

It keeps only the newest state of each unit and alarm, so its size is bounded by their number,
however long it is not emptied.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock

from base_station.views.wire import AlarmView, Delta, HealthView, Snapshot, UnitView


@dataclass(slots=True)
class Changes:
    """Changes since the last call, the picture first."""

    picture: Snapshot | None = None  # everything before it is void
    units: dict[str, UnitView] = field(default_factory=dict)
    alarms: dict[str, AlarmView] = field(default_factory=dict)
    health: HealthView | None = None


class Mailbox:
    """Mailbox that one thread fills and another one empties."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._changes = Changes()

    def put_delta(self, delta: Delta) -> None:
        with self._lock:
            for unit in delta.units:
                self._changes.units[unit.unit_id] = unit
            for alarm in delta.alarms:
                self._changes.alarms[alarm.alarm_id] = alarm
            self._changes.health = delta.health or self._changes.health

    def put_picture(self, picture: Snapshot) -> None:
        with self._lock:
            self._changes = Changes(picture=picture)

    def take(self) -> Changes:
        with self._lock:
            changes, self._changes = self._changes, Changes()
        return changes
