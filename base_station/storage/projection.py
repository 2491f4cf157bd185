"""Projection of the log into the database, and the interface of its writer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import msgspec

from shared.messages import AlarmChange, FusedPosition, OperatorAction, UnitDescription


class Projection(msgspec.Struct, frozen=True):
    """Changes of the database by one step of the engine; every part is idempotent, so that a log
    may be projected again.
    """

    t_ns: int  # station time
    alarms: tuple[AlarmChange, ...] = ()
    tracks: tuple[FusedPosition, ...] = ()  # at most one a second and unit
    actions: tuple[OperatorAction, ...] = ()  # that were accepted
    descriptions: tuple[UnitDescription, ...] = ()
    last_messages: tuple[tuple[str, int], ...] = ()  # (unit id, station time), every 5 s or so
    news: tuple[str, ...] = ()  # closed incidents with later messages
    opened: tuple[tuple[str, str], ...] = ()  # (incident id, id of its site)
    # (unit id, incident id, station time) of coming to an incident; empty: of leaving it
    memberships: tuple[tuple[str, str, int], ...] = ()

    @property
    def is_urgent(self) -> bool:
        """True where it has more than positions and times of last messages."""
        return bool(self.actions or self.alarms or self.descriptions)


class ProjectionSink(Protocol):
    """The SQL store's writer."""

    def project(self, projection: Projection) -> None:
        """Queue a projection.  Never raises where the database fails: ``problem`` reports it, and
        it is tried again.
        """
        ...

    def problem(self) -> str:
        """Reason why the database is behind, as a sentence for a person; empty: it is not."""
        ...


class ProjectedTables(Protocol):
    """Projected tables, for readers that need them up to date."""

    def flush(self) -> bool:
        """Wait, with a limit, until all projections before this call are in the tables; False where
        they are not.
        """
        ...

    def flush_soon(self) -> Callable[[], bool]:
        """Have decisions before this call written now, without waiting.  Returns a function that
        gives True when they are in the tables, or the database does not take them.
        """
        ...

    def flush_actions_soon(self) -> Callable[[], bool]:
        """As ``flush_soon``, for readers of nothing but operators' actions: incidents and units."""
        ...


class FinishedTables:
    """``ProjectedTables`` into which nothing more is projected."""

    def flush(self) -> bool:
        return True

    def flush_soon(self) -> Callable[[], bool]:
        return self.flush

    def flush_actions_soon(self) -> Callable[[], bool]:
        return self.flush
