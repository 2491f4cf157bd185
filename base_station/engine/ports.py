"""Ports of the engine: the feed and the log it works with, and its ways to consoles and operators.

The engine (or a replay) is the only thread that touches the live state.  It calls everything here
in that thread unless a method states otherwise, so an implementation takes what it is given and
returns at once: a queue and a thread or loop of its own do the slow part.
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
from shared.coded_text import text_with_code
from shared.messages.station import Action

Record = tuple[int, str, bytes]  # station time, key, payload
Trails = Mapping[str, msgspec.Raw]  # by unit: its points, encoded


class Feed(Protocol):
    """Source of records while the station is live."""

    @property
    def follows(self) -> bool:
        """True if what ``take`` gave last is another station's log, ticks and actions included:
        it is kept and stepped as it is, and nothing is decided here.
        """
        ...

    def take(self, timeout_s: float) -> Sequence[Record]:
        """Records that came since, in order; waits for something to come or for ``wake``."""
        ...

    def wake(self) -> None:
        """From any thread: end the wait of ``take``."""
        ...


class Log(Protocol):
    """Store of records; never waits long and never raises for a disk that fails."""

    @property
    def problem(self) -> str:
        """Reason why records are not kept, as a sentence for a person; empty: they are."""
        ...

    @property
    def low_disk_space(self) -> str:
        """Warning that room is short, as a sentence for a person; empty: there is room."""
        ...

    @property
    def is_behind(self) -> bool:
        """True where records of a second ago may not be on the disk yet."""
        ...

    @property
    def refuses(self) -> bool:
        """True where it would not keep a record now."""
        ...

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        """Keep a record, soon on the disk; False: it is lost."""
        ...

    def flush(self) -> bool:
        """Flush all written records to the disk; True if that was done in time."""
        ...


class LiveSink(Protocol):
    """The console hub.  ``seq`` counts deltas; a snapshot carries that of the last delta before
    it, so a client that has just got a snapshot goes on with the very next delta.
    """

    def delta(self, delta: Delta) -> None:
        """At most 20 a second, for every client that is up to date."""
        ...

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        """Plan, anchor or incident changed, or a replay jumped: every client begins again."""
        ...


class LiveSource(Protocol):
    """Source of a console's content: the live engine, or one replay."""

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        """From any thread.  ``deliver`` is called once in the source's thread, in order with the
        calls of its ``LiveSink``; after the source has stopped it is never called.
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
        """Result of the earlier request with this id; None where there is none."""
        first = idempotency.earlier_result(state, action_id)
        if first is None:
            return None
        reason = text_with_code(first.refused, first.refused_code)
        refused = Refused(first.action_id, reason) if reason else None
        return ActionResult(first.action_id, first.t_ns, refused, first.created_id)


class OperatorGate(Protocol):
    """Entry of operator actions into the engine."""

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        """From any thread.  The future is done once the action is in the log and in the live
        state; it carries ``StoreError`` where the station is stopping.  With an ``action_id`` of a
        client's (``core.idempotency``) the result is that of the first request with that client's
        key, now or before.
        """
        ...


class DeliveryResult(NamedTuple):
    """Fate of messages that were handed to the engine at once, one entry each."""

    admissions: tuple[Admission, ...]

    def count(self, admission: Admission) -> int:
        return self.admissions.count(admission)


class EngineGate(OperatorGate, Protocol):
    """Entry of operator actions, and of units' messages that wait for an answer."""

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        """From any thread: keys and payloads of units' messages.  The future is done once those
        that are new are in the log, on the disk; it carries ``StoreError`` where one of them is
        not kept, and then all of them may be delivered again.
        """
        ...


@dataclass(frozen=True)
class EnginePorts:
    """Everything the engine works with."""

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
