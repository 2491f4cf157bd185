"""What leaves the station's drive thread, and how people's actions get into it.

The drive (or a replay) is the only one that touches the live state.  Everything below is called
in its thread unless said otherwise, so an implementation takes what it is given and returns at
once: a queue and a thread or loop of its own do the slow part.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Protocol

import msgspec

from base_station import once
from base_station.events import Refused
from base_station.live_state import StationState
from base_station.views.wire import Delta, Snapshot
from shared.messages import AlarmChange, FusedPosition, OperatorAction, UnitDescription
from shared.messages.station import Action

PhotoUrls = Callable[[str], str | None]  # person id -> where the console finds the photo
Trails = Mapping[str, msgspec.Raw]  # by unit: its points, encoded


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
    """What a client of the console listens to: the live drive, or one replay."""

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        """From any thread.  ``deliver`` is called once in the source's thread, in order with the
        calls of its ``LiveSink``; after the source has stopped it is never called.
        """
        ...


class Projection(msgspec.Struct, frozen=True):
    """What one step of the drive changes in the queryable store; every part is idempotent, so
    that a log may be projected again.
    """

    t_ns: int  # station time
    alarms: tuple[AlarmChange, ...] = ()
    tracks: tuple[FusedPosition, ...] = ()  # at most one a second and unit
    actions: tuple[OperatorAction, ...] = ()  # that were accepted
    descriptions: tuple[UnitDescription, ...] = ()
    heard: tuple[tuple[str, int], ...] = ()  # (unit id, station time), every five seconds or so
    news: tuple[str, ...] = ()  # closed incidents of whose time more is known


class ProjectionSink(Protocol):
    """The SQL store's writer."""

    def project(self, projection: Projection) -> None:
        """Never raises for a store that fails: it says so in ``problem`` and tries again."""
        ...

    def problem(self) -> str:
        """Why the store is not keeping up, as a sentence for a person; empty: all is well."""
        ...


class ActionDone(msgspec.Struct, frozen=True):
    """A person's action was recorded and stepped."""

    action_id: str
    t_ns: int  # station time
    refused: Refused | None  # why it had no effect
    made_id: str = ""  # of the command, pin or incident; empty: it makes none

    @staticmethod
    def before(state: StationState, action_id: str) -> ActionDone | None:
        """What became of it when its client asked first; None: nothing is known of that."""
        first = once.done_before(state, action_id)
        if first is None:
            return None
        refused = Refused(first.action_id, first.refused) if first.refused else None
        return ActionDone(first.action_id, first.t_ns, refused, first.made_id)


class OperatorGate(Protocol):
    """How the API hands people's actions to the drive."""

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionDone]:
        """From any thread.  The future is done once the action is in the log and in the live
        state; it carries ``StoreError`` where the station is stopping.  With an ``action_id`` of a
        client's (``base_station.once``) it tells what was done with that client's key, now or
        before.
        """
        ...
