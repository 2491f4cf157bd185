"""Fan-out of live messages: consoles and forwarders get the same."""

from __future__ import annotations

from typing import Any, cast

from base_station.app.live_fan_out import LiveFanOut
from base_station.engine.ports import LiveSource
from base_station.forwarders.interface import Forwarder
from base_station.forwarders.running import Forwarders
from base_station.views.wire import Delta, Snapshot
from tests.rig.live_station import Screen
from tests.rig.tak_scene import Scene, delta


class RecordingForwarder:
    """A forwarder that records its input."""

    def __init__(self) -> None:
        self.given: list[object] = []

    def delta(self, delta: Delta) -> None:
        self.given.append(delta)

    def reset(self, snapshot: Snapshot) -> None:
        self.given.append(snapshot)

    def start(self) -> None:
        self.given.append("started")


class Source:
    """A ``LiveSource`` that answers at once."""

    def __init__(self, picture: Snapshot) -> None:
        self.asked = 0
        self._picture = picture

    def request_snapshot(self, deliver: Any) -> None:
        self.asked += 1
        deliver(self._picture, {})


def test_forwarder_begins_with_the_snapshot_and_gets_the_messages_of_consoles() -> None:
    screen, received, picture = Screen(), RecordingForwarder(), Scene().picture()
    shown = LiveFanOut(screen, Forwarders([cast("Forwarder", received)]))
    source = Source(picture)
    shown.start(cast("LiveSource", source))
    change = delta()
    shown.delta(change)
    shown.reset(picture, {})
    assert received.given == [picture, "started", change, picture]
    assert (screen.deltas, screen.resets) == ([change], [picture])


def test_engine_makes_no_snapshot_without_forwarders() -> None:
    source = Source(Scene().picture())
    LiveFanOut(Screen(), Forwarders([])).start(cast("LiveSource", source))
    assert source.asked == 0
