"""What the live station's drive works with: where records come from, where they go, who listens."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from base_station.commands.state import Order
from base_station.journals.backfill import Report
from base_station.live.sinks import LiveSink, PhotoUrls, ProjectionSink
from base_station.past.checkpoints import Checkpoints
from base_station.views.station import StationFacts
from shared.clock import Clock

Record = tuple[int, str, bytes]  # station time, key, payload


class Feed(Protocol):
    """Where records come from while the station is live."""

    @property
    def follows(self) -> bool:
        """Whether what ``take`` gave last is another station's log, ticks and actions included:
        it is kept and stepped as it is, and nothing is decided here.
        """
        ...

    def take(self, timeout_s: float) -> Sequence[Record]:
        """What came since, in order; waits for something to come or for ``wake``."""
        ...

    def wake(self) -> None:
        """From any thread: end the wait of ``take``."""
        ...


class Log(Protocol):
    """Where records are kept; never waits long and never raises for a disk that fails."""

    @property
    def problem(self) -> str:
        """Why records are not kept, as a sentence for a person; empty: they are."""
        ...

    @property
    def little_room(self) -> str:
        """That soon no more are kept, as a sentence for a person; empty: there is room."""
        ...

    @property
    def is_behind(self) -> bool:
        """Whether records of a second ago may not be on the disk yet."""
        ...

    @property
    def refuses(self) -> bool:
        """Whether it would not keep a record now."""
        ...

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        """Keep a record, soon on the disk; False: it is lost."""
        ...

    def flush(self) -> bool:
        """Bring to the disk what was written so far; whether that was done in time."""
        ...


@dataclass(frozen=True)
class DrivePorts:
    """What the drive works with."""

    feed: Feed
    log: Log
    live: LiveSink
    projection: ProjectionSink
    checkpoints: Checkpoints
    photo_urls: PhotoUrls
    facts: Callable[[], StationFacts]  # asked once a second; messages a second are filled in
    # Hears once a second what is there of each linked unit, and whether it may not be on the disk.
    report: Callable[[Report, bool], None]
    linked: Callable[[], frozenset[str]]  # units whose link is there
    unlinked: Callable[[], frozenset[str]]  # whose link was there and is gone
    say: Callable[[Sequence[Order]], None]  # hears what no unit has answered
    clock: Clock
    boot_id: int
