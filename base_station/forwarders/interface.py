"""Interface of a forwarder: a live connection with another system of the incident.

A forwarder gets the snapshots and deltas of consoles, in the engine's thread, and returns at once;
a thread of its own does the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from base_station.storage.db.known_people import PersonLookup
from base_station.storage.projection import Projection
from base_station.views.wire import Delta, ForwarderView, Snapshot
from shared.clock import Clock
from shared.messages import ExternalMarker


class Forwarder(Protocol):
    """One configured connection; ``start`` once, ``close`` once."""

    def delta(self, delta: Delta) -> None:
        """Take changes; in the engine's thread."""
        ...

    def reset(self, snapshot: Snapshot) -> None:
        """Take the whole picture, which replaces the former one; in the engine's thread."""
        ...

    def project(self, projection: Projection) -> None:
        """Take decisions, which are in the log; in the engine's thread.  After a kill those since
        the last checkpoint come again.
        """
        ...

    def start(self) -> None: ...

    def close(self) -> None: ...

    def view(self) -> ForwarderView:
        """State of the connection, for the station's health."""
        ...

    def problem(self) -> str:
        """Sentence for an alarm: the other system is away for long; empty: it is not."""
        ...


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Parts of the station that every forwarder uses."""

    clock: Clock
    leads: Callable[[], bool]  # False: the other one of two stations forwards
    data: Path  # folder of the station
    people: PersonLookup  # by person id
    read_log: Callable[[int], Iterable[tuple[int, str, bytes]]]  # from that station time on
    # Takes people and markers of other teams that changed, and ids of those that are gone.
    note_external: Callable[[tuple[ExternalMarker, ...], tuple[str, ...]], None]


@dataclass(frozen=True, slots=True)
class ForwarderKind:
    """Kind of forwarder, and the table of the settings in which each has a name."""

    table: str
    make: Callable[[str, Any, Surroundings], Forwarder]
