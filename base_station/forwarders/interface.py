"""Interface of a forwarder: a live connection with another system of the incident.

A forwarder receives the snapshots and deltas of consoles in the engine's thread, and must return at
once; a thread of its own does the rest.
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
    """One configured connection; ``start`` and ``close`` are called once."""

    def delta(self, delta: Delta) -> None:
        """Receive changes, in the engine's thread."""
        ...

    def reset(self, snapshot: Snapshot) -> None:
        """Receive the whole picture, which replaces the former one, in the engine's thread."""
        ...

    def project(self, projection: Projection) -> None:
        """Receive decisions that are in the log, in the engine's thread.  After a kill those since
        the last checkpoint come again.
        """
        ...

    def start(self) -> None: ...

    def close(self) -> None: ...

    def view(self) -> ForwarderView:
        """State of the connection, for the station's health."""
        ...

    def problem(self) -> str:
        """Sentence for an alarm if the other system cannot be reached for long; otherwise empty."""
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
