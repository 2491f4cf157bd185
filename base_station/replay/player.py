"""Player: moves through the past and publishes it; without threads and without a clock."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from base_station.engine.ports import Trails
from base_station.replay.record_gaps import RecordGap
from base_station.views.wire import ReplayView, Snapshot


class Player(Protocol):
    @property
    def at_ns(self) -> int: ...

    @property
    def gap(self) -> RecordGap | None:
        """Gap of the record at the present place; None: there is none."""
        ...

    @property
    def is_lost(self) -> bool:
        """It cannot show where it was sent: another player can."""
        ...

    def seek(self, t_ns: int) -> Iterator[None]:
        """Go to ``t_ns``, back or forth, pausing now and then so that it can be given up."""
        ...

    def advance(self, t_ns: int) -> bool:
        """Take some of the events until ``t_ns``; False: all is done."""
        ...

    def reset(self, view: ReplayView) -> None:
        """Send a new snapshot to all consoles."""
        ...

    def publish(self, view: ReplayView, *, whole: bool) -> None:
        """Publish changes; ``whole``: and the station's health."""
        ...

    def snapshot(self, view: ReplayView) -> tuple[Snapshot, Trails]:
        """Snapshot for one console, after pending changes were published to all."""
        ...
