"""A replay without a log, which notes what it is told."""

from __future__ import annotations

from collections.abc import Callable

from base_station.engine.ports import Trails
from base_station.views.wire import ReplayView, Snapshot


class NotedReplay:
    def __init__(self) -> None:
        self.reported: list[str] = []
        self.closed = False
        self.is_over = False

    def play(self) -> None:
        self.reported.append("play")

    def pause(self) -> None:
        self.reported.append("pause")

    def seek(self, t_ns: int) -> None:
        self.reported.append(f"seek {t_ns}")

    def set_speed(self, speed: float) -> None:
        self.reported.append(f"speed {speed}")

    def view(self) -> ReplayView:
        return ReplayView("i-1", 0, 1, 0, 1.0, playing=True)

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None: ...

    def close(self) -> None:
        self.closed = True
