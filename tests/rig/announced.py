"""Announcers that send nothing, in place of those of the network."""

from __future__ import annotations

from base_station.app.service_announcement import AnyAnnouncement
from shared.errors import BusError


class Announced:
    """Announcers in place of those that send."""

    def __init__(self) -> None:
        self.now: list[tuple[AnyAnnouncement, tuple[str, ...]]] = []
        self.fault: BusError | None = None

    def begin(self, announcement: AnyAnnouncement, interfaces: tuple[str, ...]) -> Announced:
        if self.fault is not None:
            raise self.fault
        self.now.append((announcement, interfaces))
        return self

    def close(self) -> None:
        self.now.pop()
