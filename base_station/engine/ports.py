"""Ports of the engine: the feed and the log with which it works, and its interfaces to consoles and
operators.

The engine (or a replay) is the only thread that touches the live state.  It calls all methods in
that thread unless a method states otherwise, so an implementation must return at once: slow work is
done in a thread or loop of its own, behind a queue.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import msgspec

from base_station.core import idempotency
from base_station.core.events import Refused
from base_station.core.state import StationState
from base_station.core.state.command import Order
from base_station.engine.admission import Admission
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.known_people import PersonLookup
from base_station.storage.projection import ProjectionSink
from base_station.unit_sync.backfill import Report
from base_station.views.station import StationFacts
from base_station.views.wire import Delta, Snapshot
from shared.clock import Clock
from shared.coded_text import with_code
from shared.messages.station import Action

Record = tuple[int, str, bytes]  # station time, key, payload
Trails = Mapping[str, msgspec.Raw]  # by unit: its points, encoded


class Feed(Protocol):
    """Source of records while the station is live."""

    @property
    def follows(self) -> bool:
        """True if the last records that ``take`` returned are another station's log, with ticks and
        actions: they are kept and stepped as they are, and nothing is decided here.
        """
        ...

    def take(self, timeout_s: float) -> Sequence[Record]:
        """Return the new records in order; waits for a record or for ``wake``."""
        ...

    def wake(self) -> None:
        """End the wait of ``take``. Thread-safe."""
        ...


class Log(Protocol):
    """Store of records.  It never waits long, and never raises when a disk fails."""

    @property
    def problem(self) -> str:
        """Sentence about why records are not kept; empty if they are."""
        ...

    @property
    def low_disk_space(self) -> str:
        """Sentence that warns of low disk space; empty if there is enough."""
        ...

    @property
    def is_behind(self) -> bool:
        """True if records of a second ago may not be on disk yet."""
        ...

    @property
    def refuses(self) -> bool:
        """True if it would not keep a record now."""
        ...

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        """Keep a record, which will be on disk soon.  False if it is lost."""
        ...

    def flush(self) -> bool:
        """Flush all written records to disk.  True if that was done in time."""
        ...


class LiveSink(Protocol):
    """Receiver of a console's content, such as the hub.  ``seq`` counts deltas; a snapshot carries
    that of the last delta before it, so a client that has just received a snapshot continues with
    the next delta.
    """

    def delta(self, delta: Delta) -> None:
        """Send a delta to every client that is up to date; called 20 times a second at most."""
        ...

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        """Make every client begin again: plan, anchor or incident changed, or a replay jumped."""
        ...


class LiveSource(Protocol):
    """Source of a console's content: the live engine, or one replay."""

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        """Request a snapshot.  Thread-safe.  ``deliver`` is called once in the source's thread, in
        order with the calls of its ``LiveSink``; after the source has stopped it is never called.
        """
        ...


class ActionResult(msgspec.Struct, frozen=True):
    """Result of an operator action that was logged and applied."""

    action_id: str
    t_ns: int  # station time
    refused: Refused | None  # why it had no effect
    created_id: str = ""  # of the command, pin or incident; empty: it makes none

    @staticmethod
    def before(state: StationState, action_id: str) -> ActionResult | None:
        """Result of the earlier request with this id; None if there was none."""
        first = idempotency.earlier_result(state, action_id)
        if first is None:
            return None
        reason = with_code(first.refused, first.refused_code)
        refused = Refused(first.action_id, reason) if reason else None
        return ActionResult(first.action_id, first.t_ns, refused, first.created_id)


class OperatorGate(Protocol):
    """Entry of operator actions into the engine."""

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        """Queue an action.  Thread-safe.  The future is done once the action is in the log and in
        the live state; it carries ``StoreError`` if the station is stopping.  With an ``action_id``
        of a client (``core.idempotency``) the result is that of the first request with that
        client's key, now or before.
        """
        ...


class DeliveryResult(NamedTuple):
    """Outcome for messages that were handed to the engine together, one entry for each."""

    admissions: tuple[Admission, ...]

    def count(self, admission: Admission) -> int:
        return self.admissions.count(admission)


class EngineGate(OperatorGate, Protocol):
    """Entry of operator actions, and of units' messages that wait for an answer."""

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        """Queue keys and payloads of units' messages.  Thread-safe.  The future is done once the
        new ones are in the log, on disk; it carries ``StoreError`` if one of them was not kept, and
        then all of them may be delivered again.
        """
        ...


@dataclass(frozen=True)
class EnginePorts:
    """Parts with which the engine works."""

    feed: Feed
    log: Log
    live: LiveSink
    projection: ProjectionSink
    checkpoints: Checkpoints
    people: PersonLookup  # by person id
    facts: Callable[[], StationFacts]  # asked once a second; messages a second are filled in
    # Called once a second with the received numbers of each linked unit, and whether the disk may
    # lack them.
    report: Callable[[Report, bool], None]
    linked: Callable[[], frozenset[str]]  # units with a link
    unlinked: Callable[[], frozenset[str]]  # units that have lost their link
    send_orders: Callable[[Sequence[Order]], None]  # those that no unit has answered
    clock: Clock
    boot_id: int
